"""Popov's pi l/4: the row of a cylinder that needs neither thickness nor datum."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.load_curves.base import LoadCurve
from lumped.load_curves.line_profile import hertz_pressure
from lumped.numbers import Real


@dataclass(frozen=True)
class Popov(LoadCurve):
    """The row F = (pi/4) E* l depth of the paper's Table 1, here per unit length, with b^2 = R depth: a heuristic.

    It takes the approach of a sphere for that of a cylinder, which has none; no body follows it at more than one depth.
    `radius` R in m. Popov 2010, ISBN 978-3-642-10802-0, chapter 5.
    """

    radius: float

    def force(self, depth: ArrayLike) -> Real:
        """(pi/4) depth, m."""
        return 0.25 * pi * np.maximum(depth, 0.0)

    def contact_radius(self, depth: ArrayLike) -> Real:
        """sqrt(R depth), m."""
        return np.sqrt(self.radius * np.maximum(depth, 0.0))

    def depth(self, contact_radius: ArrayLike) -> Real:
        """b^2/R, m."""
        return np.asarray(contact_radius) ** 2 / self.radius

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """2 b/R."""
        return 2.0 * np.asarray(contact_radius) / self.radius

    def dforce_ddepth(self, depth: ArrayLike) -> Real:
        """pi/4."""
        return np.where(np.asarray(depth) >= 0.0, 0.25 * pi, 0.0)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> NDArray[np.float64]:
        """sqrt(b^2-x^2)/(2R)."""
        return hertz_pressure(radius, contact_radius, self.radius)
