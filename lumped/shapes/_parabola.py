"""The paraboloid which stands for a sphere when `model.profile = "parabola"`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.keys import Key, Number, check_fields
from lumped.load_curves.hertz import Hertz, HertzImpact, hertz_impact
from lumped.shapes.base import Shape

KEYS: Mapping[str, Key] = {"radius": Number(1e-9, 1e4, "m")}


@dataclass(frozen=True)
class Parabola(Shape):
    """h(r) = r^2/(2R), R in m: no shape of a scene file, but what its sphere may resolve to."""

    radius: float
    name: ClassVar[str] = "parabola"
    keys: ClassVar[Mapping[str, Key]] = KEYS

    def __post_init__(self) -> None:
        check_fields("parabola", self, KEYS)

    def height(self, r: ArrayLike) -> NDArray[np.float64]:
        """r^2/(2R)."""
        return np.asarray(np.asarray(r, dtype=float) ** 2 / (2.0 * self.radius))

    def slope(self, r: ArrayLike) -> NDArray[np.float64]:
        """r/R."""
        return np.asarray(np.abs(np.asarray(r, dtype=float)) / self.radius)

    def mdr_profile(self, x: ArrayLike) -> NDArray[np.float64]:
        """x^2/R."""
        return np.asarray(np.asarray(x, dtype=float) ** 2 / self.radius)

    @property
    def exponent_of_force(self) -> float:
        """3/2."""
        return 1.5

    @property
    def tip_radius(self) -> float:
        """Its radius, m."""
        return self.radius

    @property
    def load_curve(self) -> Hertz:
        """Hertz's closed form."""
        return Hertz(self.radius)

    def resolved(self, profile: str) -> Shape:
        """Itself."""
        return self

    def hertz_impact(self, modulus: float, mass: float, velocity: float) -> HertzImpact:
        """Scales of the Hertz impact, here exact."""
        return hertz_impact(self.radius, modulus, mass, velocity)
