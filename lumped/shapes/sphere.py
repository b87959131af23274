"""The sphere."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.load_curves.sneddon_sphere import SneddonSphere
from lumped.shapes import _round
from lumped.shapes._outlines import circle, circle_slope
from lumped.shapes._parabola import Parabola
from lumped.shapes.base import Shape

KEYS = _round.KEYS


@dataclass(frozen=True)
class Sphere(_round.RoundShape):
    """A sphere of this radius, m. Raises BadInput for a radius out of range."""

    name: ClassVar[str] = "sphere"

    def height(self, r: ArrayLike) -> NDArray[np.float64]:
        """R - sqrt(R^2-r^2), infinite beyond R."""
        return circle(r, self.radius)

    def slope(self, r: ArrayLike) -> NDArray[np.float64]:
        """r/sqrt(R^2-r^2), infinite from R on."""
        return circle_slope(r, self.radius)

    def mdr_profile(self, x: ArrayLike) -> NDArray[np.float64]:
        """x artanh(x/R)."""
        ratio = np.asarray(x, dtype=float) / self.radius
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(ratio <= 1.0, self.radius * ratio * np.arctanh(ratio), np.inf)

    def whole_mass(self, density: float) -> float:
        """density 4/3 pi R^3, kg."""
        return density * 4.0 / 3.0 * math.pi * self.radius**3

    @property
    def load_curve(self) -> SneddonSphere:
        """Sneddon's closed form."""
        return SneddonSphere(self.radius)

    def resolved(self, profile: str) -> Shape:
        """Itself, or the parabola with the same curvature."""
        return Parabola(self.radius) if profile == "parabola" else self


def of(radius: float) -> Sphere:
    """A sphere of `radius`, m."""
    return Sphere(radius)
