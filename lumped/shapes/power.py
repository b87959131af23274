"""The profile c r^n: a continuous family from the cone to the flat punch."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lumped.load_curves.power import Power
from lumped.numbers import Array
from lumped.schema.keys import Key, Number, Part
from lumped.shapes.base import Shape


@dataclass(frozen=True)
class PowerProfile(Shape):
    """height = coefficient r^exponent. Raises BadInput for a value out of range."""

    coefficient: Annotated[float, Key(Number(1e-300, 1e300, "m^(1-n)"), "c of the height c r^n")]
    exponent: Annotated[float, Key(Number(1.0, 20.0), "n of the height c r^n")]
    name: ClassVar[str] = "power"

    def height(self, r: ArrayLike) -> Array:
        """c r^n."""
        return np.asarray(self.coefficient * np.abs(np.asarray(r, dtype=float)) ** self.exponent)

    def slope(self, r: ArrayLike) -> Array:
        """n c r^(n - 1)."""
        ratio = np.abs(np.asarray(r, dtype=float))
        return np.asarray(self.exponent * self.coefficient * ratio ** (self.exponent - 1.0))

    @property
    def exponent_of_force(self) -> float:
        """1 + 1/n."""
        return 1.0 + 1.0 / self.exponent

    @property
    def load_curve(self) -> Power:
        """Galin's and Sneddon's closed form."""
        return Power(self.coefficient, self.exponent)


MEMBER = Part(PowerProfile)
