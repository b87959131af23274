"""The contract of a striker's profile; outlines of what is round, over the distance r from the lowest point."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import BadInput, Fault
from lumped.load_curves.base import LoadCurve
from lumped.load_curves.bent import BentCurve
from lumped.load_curves.hertz import HertzImpact, curve_impact, power_impact
from lumped.load_curves.plane_contact import LineProfile
from lumped.materials import Material, Relaxation
from lumped.numbers import Array
from lumped.schema import Table
from lumped.schema.keys import Number, Record, written

SIZE = Number(1e-9, 1e4, "m")  # of a body, but for one that may be long beside its contact


class Shape(Record, ABC):
    """An axisymmetric convex profile: height above its lowest point over the distance r from the axis.

    Its `name` is that of the scene file, its keys stand beside its fields. Lengths in m; radii are scalars or arrays.
    `plane`: in plane strain instead, r the distance from the plane of symmetry; forces are totals over its `length`.
    """

    plane: ClassVar[bool] = False

    @abstractmethod
    def height(self, r: ArrayLike) -> Array:
        """Height h(r), m, infinite where the profile has ended."""

    @abstractmethod
    def slope(self, r: ArrayLike) -> Array:
        """h'(r)."""

    @property
    @abstractmethod
    def exponent_of_force(self) -> float:
        """alpha in F ~ depth^alpha on the half-space, Table 1; for the true sphere that of its start."""

    @property
    def line_profile(self) -> LineProfile:
        """The profile of a contact per unit length, of a shape in plane strain. Raises BadInput for any other."""
        raise BadInput(Fault("shape", "striker.shape", f"{self.name} is no cylinder"))

    @property
    def total(self) -> float:
        """What a force is multiplied by: the length of a shape in plane strain, m, else 1."""
        return 1.0

    @property
    def fixed_radius(self) -> float | None:
        """Contact radius that no depth changes, m; None where it grows with the depth."""
        return None

    @property
    def flat_radius(self) -> float:
        """Contact radius of the first touch, m: zero, but where the lowest part is flat."""
        return self.fixed_radius or 0.0

    @property
    def tip_radius(self) -> float | None:
        """Radius of curvature of the lowest point, m; None where it has none."""
        return None

    def own_mass(self, density: float) -> float:
        """Mass, kg, of a body of a density, kg/m3, that its scene does not give; 0 of a profile alone."""
        return 0.0

    def whole_mass(self, density: float) -> float | None:
        """Mass, kg, of a body of a density, kg/m3, that its scene has to give; None where the shape is a profile."""
        return None

    @property
    @abstractmethod
    def load_curve(self) -> LoadCurve:
        """The closed form of elastic indentation by this profile."""

    def modulus(self, material: Material) -> Relaxation:
        """The modulus which forces by this shape are in proportion to, Pa: E* of the half-space by default."""
        return material.contact_modulus()

    def resolved(self, profile: str) -> Shape:
        """The shape that `model.profile` ("exact" or "parabola") asks for: itself where it has no other profile."""
        return self

    def hertz_impact(self, modulus: float, mass: float, velocity: float) -> HertzImpact:
        """Scales of the elastic impact by the profile's tip: contact modulus, Pa, mass, kg, velocity, m/s.

        Here those of a force which is a power of the depth throughout, exact.
        """
        return power_impact(self.load_curve, self.exponent_of_force, modulus, mass, velocity)

    def check_contact(self, contact_radius: float) -> str:
        """What is wrong with a contact as wide, m, under this profile; empty where nothing is."""
        return ""

    def to_dict(self) -> Table:
        """The shape's part of the striker's table."""
        return {"shape": self.name} | written(self)


class Mixed(Shape):
    """A profile whose force is no power of the depth."""

    def hertz_impact(self, modulus: float, mass: float, velocity: float) -> HertzImpact:
        """Scales of the elastic impact, from the work of indentation."""
        return curve_impact(self.load_curve, modulus, mass, velocity)


class Bent(Mixed):
    """A profile whose slope is linear piece by piece: h'(r) = s + sum c_k (r - t_k)_+, as its load curve has them."""

    @property
    @abstractmethod
    def load_curve(self) -> BentCurve:
        """The closed form of its bends."""

    @property
    def flat_radius(self) -> float:
        """That of its load curve, m."""
        return self.load_curve.least_radius

    def height(self, r: ArrayLike) -> Array:
        """s r + sum c_k (r - t_k)_+^2/2, m."""
        curve = self.load_curve
        return np.asarray(curve.slope * np.abs(r) + 0.5 * np.square(self._beyond(r)) @ np.array(curve.bends))

    def slope(self, r: ArrayLike) -> Array:
        """s + sum c_k (r - t_k)_+."""
        return np.asarray(self.load_curve.slope + self._beyond(r) @ np.array(self.load_curve.bends))

    def _beyond(self, r: ArrayLike) -> Array:
        """(r - t_k)_+, m, the bends last."""
        radius = np.abs(np.asarray(r, dtype=float))
        return np.asarray(np.maximum(radius[..., None] - np.array(self.load_curve.radii), 0.0))


class FlatEnded(Shape):
    """Flat up to its own radius, nothing beyond: a force in proportion to the depth."""

    exponent_of_force: ClassVar[float] = 1.0

    def height(self, r: ArrayLike) -> Array:
        """Zero up to the rim, infinite beyond."""
        return np.where(np.abs(np.asarray(r, dtype=float)) <= self.fixed_radius, 0.0, np.inf)

    def slope(self, r: ArrayLike) -> Array:
        """Zero up to the rim, infinite beyond."""
        return self.height(r)

    @property
    @abstractmethod
    def fixed_radius(self) -> float:
        """That of the rim, m."""


class Round(Shape):
    """A profile with a `radius` R at its tip, m."""

    radius: float

    @property
    def tip_radius(self) -> float:
        """R, m."""
        return self.radius


class Circular(Round):
    """An outline that is a circle."""

    def height(self, r: ArrayLike) -> Array:
        """R - sqrt(R^2-r^2) = r^2/(R + sqrt(R^2-r^2)), m, which cancels no digit; infinite beyond R."""
        square = (np.asarray(r, dtype=float) / self.radius) ** 2
        rise = self.radius * square / (1.0 + np.sqrt(np.maximum(1.0 - square, 0.0)))
        return np.where(square <= 1.0, rise, np.inf)

    def slope(self, r: ArrayLike) -> Array:
        """r/sqrt(R^2-r^2), infinite from R on."""
        ratio = np.abs(np.asarray(r, dtype=float)) / self.radius
        with np.errstate(divide="ignore"):
            return np.where(ratio < 1.0, ratio / np.sqrt(np.maximum(1.0 - ratio**2, 0.0)), np.inf)


class Parabolic(Round):
    """An outline that is a parabola."""

    def height(self, r: ArrayLike) -> Array:
        """r^2/(2R), m."""
        return np.asarray(np.asarray(r, dtype=float) ** 2 / (2.0 * self.radius))

    def slope(self, r: ArrayLike) -> Array:
        """r/R."""
        return np.asarray(np.abs(np.asarray(r, dtype=float)) / self.radius)
