"""The profile c r^n: a continuous family from the cone to the flat punch."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.load_curves.hertz import HertzImpact, power_impact
from lumped.load_curves.power import Power
from lumped.schema.key_table import check_fields
from lumped.schema.keys import Key, Number
from lumped.shapes.base import Shape

KEYS: Mapping[str, Key] = {
    "coefficient": Number(1e-300, 1e300, "m^(1-n)"),
    "exponent": Number(1.0, 20.0),
}


@dataclass(frozen=True)
class PowerProfile(Shape):
    """height = coefficient r^exponent. Raises BadInput for a value out of range."""

    coefficient: float
    exponent: float
    name: ClassVar[str] = "power"
    keys: ClassVar[Mapping[str, Key]] = KEYS

    def __post_init__(self) -> None:
        check_fields("power", self, KEYS)

    def height(self, r: ArrayLike) -> NDArray[np.float64]:
        """c r^n."""
        return np.asarray(self.coefficient * np.abs(np.asarray(r, dtype=float)) ** self.exponent)

    def slope(self, r: ArrayLike) -> NDArray[np.float64]:
        """n c r^(n - 1)."""
        ratio = np.abs(np.asarray(r, dtype=float))
        return np.asarray(self.exponent * self.coefficient * ratio ** (self.exponent - 1.0))

    def mdr_profile(self, x: ArrayLike) -> NDArray[np.float64]:
        """c kappa x^n."""
        return np.asarray(self.load_curve.depth(x))

    @property
    def exponent_of_force(self) -> float:
        """1 + 1/n."""
        return 1.0 + 1.0 / self.exponent

    @property
    def load_curve(self) -> Power:
        """Galin's and Sneddon's closed form."""
        return Power(self.coefficient, self.exponent)

    def resolved(self, profile: str) -> Shape:
        """Itself: it has no other profile."""
        return self

    def hertz_impact(self, modulus: float, mass: float, velocity: float) -> HertzImpact:
        """Scales of the elastic impact, exact."""
        return power_impact(self.load_curve, self.exponent_of_force, modulus, mass, velocity)


def of(coefficient: float, exponent: float) -> PowerProfile:
    """The profile of a coefficient c, m^(1-n), and an exponent n."""
    return PowerProfile(coefficient, exponent)
