"""The paraboloid which stands for a sphere when `model.profile = "parabola"`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.load_curves.hertz import Hertz
from lumped.shapes._outlines import parabola, parabola_slope
from lumped.shapes._round import RoundShape
from lumped.shapes.base import Shape


@dataclass(frozen=True)
class Parabola(RoundShape):
    """h(r) = r^2/(2R), R in m: no shape of a scene file, but what its sphere may resolve to."""

    name: ClassVar[str] = "parabola"

    def height(self, r: ArrayLike) -> NDArray[np.float64]:
        """r^2/(2R)."""
        return parabola(r, self.radius)

    def slope(self, r: ArrayLike) -> NDArray[np.float64]:
        """r/R."""
        return parabola_slope(r, self.radius)

    def mdr_profile(self, x: ArrayLike) -> NDArray[np.float64]:
        """x^2/R."""
        return np.asarray(np.asarray(x, dtype=float) ** 2 / self.radius)

    @property
    def load_curve(self) -> Hertz:
        """Hertz's closed form."""
        return Hertz(self.radius)

    def resolved(self, profile: str) -> Shape:
        """Itself."""
        return self
