"""The sphere."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.keys import Key, Number, check_fields
from lumped.load_curves.hertz import HertzImpact, hertz_impact
from lumped.load_curves.sneddon_sphere import SneddonSphere
from lumped.shapes._parabola import Parabola
from lumped.shapes.base import Shape

KEYS: Mapping[str, Key] = {"radius": Number(1e-9, 1e4, "m")}


@dataclass(frozen=True)
class Sphere(Shape):
    """A sphere of this radius, m. Raises BadInput for a radius out of range."""

    radius: float
    name: ClassVar[str] = "sphere"
    keys: ClassVar[Mapping[str, Key]] = KEYS

    def __post_init__(self) -> None:
        check_fields("sphere", self, KEYS)

    def height(self, r: ArrayLike) -> NDArray[np.float64]:
        """R - sqrt(R^2-r^2) = r^2/(R + sqrt(R^2-r^2)), which cancels no digit; infinite beyond R."""
        square = (np.asarray(r, dtype=float) / self.radius) ** 2
        rise = self.radius * square / (1.0 + np.sqrt(np.maximum(1.0 - square, 0.0)))
        return np.where(square <= 1.0, rise, np.inf)

    def slope(self, r: ArrayLike) -> NDArray[np.float64]:
        """r/sqrt(R^2-r^2), infinite from R on."""
        ratio = np.abs(np.asarray(r, dtype=float)) / self.radius
        with np.errstate(divide="ignore"):
            return np.where(ratio < 1.0, ratio / np.sqrt(np.maximum(1.0 - ratio**2, 0.0)), np.inf)

    def mdr_profile(self, x: ArrayLike) -> NDArray[np.float64]:
        """x artanh(x/R)."""
        ratio = np.asarray(x, dtype=float) / self.radius
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(ratio <= 1.0, self.radius * ratio * np.arctanh(ratio), np.inf)

    @property
    def exponent_of_force(self) -> float:
        """3/2."""
        return 1.5

    @property
    def tip_radius(self) -> float:
        """Its radius, m."""
        return self.radius

    @property
    def load_curve(self) -> SneddonSphere:
        """Sneddon's closed form."""
        return SneddonSphere(self.radius)

    def resolved(self, profile: str) -> Shape:
        """Itself, or the parabola with the same curvature."""
        return Parabola(self.radius) if profile == "parabola" else self

    def hertz_impact(self, modulus: float, mass: float, velocity: float) -> HertzImpact:
        """Scales of the Hertz impact."""
        return hertz_impact(self.radius, modulus, mass, velocity)


def of(radius: float) -> Sphere:
    """A sphere of `radius`, m."""
    return Sphere(radius)
