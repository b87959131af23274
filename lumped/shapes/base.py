"""The contract of a striker's profile; outlines of what is round, over the distance r from the lowest point."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault
from lumped.load_curves.base import LoadCurve
from lumped.load_curves.hertz import HertzImpact
from lumped.load_curves.plane_contact import LineProfile
from lumped.materials import Material, Relaxation
from lumped.schema import Table
from lumped.schema.record import Record, written


class Shape(Record, ABC):
    """An axisymmetric convex profile: height above its lowest point over the distance r from the axis.

    Its `name` is that of the scene file, its keys stand beside its fields. Lengths in m; radii are scalars or arrays.
    `plane`: in plane strain instead, r the distance from the plane of symmetry; forces are totals over its `length`.
    """

    plane: ClassVar[bool] = False

    @abstractmethod
    def height(self, r: ArrayLike) -> NDArray[np.float64]:
        """Height h(r), m, infinite where the profile has ended."""

    @abstractmethod
    def slope(self, r: ArrayLike) -> NDArray[np.float64]:
        """h'(r)."""

    @abstractmethod
    def mdr_profile(self, x: ArrayLike) -> NDArray[np.float64]:
        """The equivalent one-dimensional profile g(x) = x int_0^x h'(r)/sqrt(x^2-r^2) dr, x >= 0."""

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

    @abstractmethod
    def resolved(self, profile: str) -> Shape:
        """The shape that `model.profile` ("exact" or "parabola") asks for."""

    @abstractmethod
    def hertz_impact(self, modulus: float, mass: float, velocity: float) -> HertzImpact:
        """Scales of the elastic impact by the profile's tip: contact modulus, Pa, mass, kg, velocity, m/s."""

    def to_dict(self) -> Table:
        """The shape's part of the striker's table."""
        return {"shape": self.name} | written(self)


def circle(r: ArrayLike, radius: float) -> NDArray[np.float64]:
    """R - sqrt(R^2-r^2) = r^2/(R + sqrt(R^2-r^2)), m, which cancels no digit; infinite beyond R."""
    square = (np.asarray(r, dtype=float) / radius) ** 2
    rise = radius * square / (1.0 + np.sqrt(np.maximum(1.0 - square, 0.0)))
    return np.where(square <= 1.0, rise, np.inf)


def circle_slope(r: ArrayLike, radius: float) -> NDArray[np.float64]:
    """r/sqrt(R^2-r^2), infinite from R on."""
    ratio = np.abs(np.asarray(r, dtype=float)) / radius
    with np.errstate(divide="ignore"):
        return np.where(ratio < 1.0, ratio / np.sqrt(np.maximum(1.0 - ratio**2, 0.0)), np.inf)


def parabola(r: ArrayLike, radius: float) -> NDArray[np.float64]:
    """r^2/(2R), m."""
    return np.asarray(np.asarray(r, dtype=float) ** 2 / (2.0 * radius))


def parabola_slope(r: ArrayLike, radius: float) -> NDArray[np.float64]:
    """r/R."""
    return np.asarray(np.abs(np.asarray(r, dtype=float)) / radius)
