"""Galin 1946: any power of the distance from the axis, c r^n."""

from __future__ import annotations

from dataclasses import dataclass
from math import gamma, inf, pi, sqrt
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import BadInput, Fault
from lumped.load_curves.half_space import HalfSpaceCurve
from lumped.numbers import Array, Real


@dataclass(frozen=True)
class Power(HalfSpaceCurve):
    """depth = beta c a^n with beta = sqrt(pi) Gamma(n/2+1)/Gamma((n+1)/2), F = 2n/(n+1) E* a depth: alpha = 1 + 1/n.

    `coefficient` c in m^(1-n), above 0; `exponent` n >= 1 (below that the profile is not convex). Raises BadInput.
    Doi 10.1016/0020-7225(65)90019-4.
    """

    coefficient: float
    exponent: float
    closed: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if not 0.0 < self.coefficient < inf:
            raise BadInput(Fault("power", "coefficient", f"must be above 0 m^(1-n), is {self.coefficient}"))
        if not 1.0 <= self.exponent <= 100.0:
            raise BadInput(Fault("power", "exponent", f"must lie in [1, 100], is {self.exponent}"))

    @property
    def _steepness(self) -> float:
        """beta c."""
        n = self.exponent
        return self.coefficient * sqrt(pi) * gamma(0.5 * n + 1.0) / gamma(0.5 * n + 0.5)

    def force(self, depth: ArrayLike) -> Real:
        """F/E*, m^2."""
        n = self.exponent
        return 2.0 * n / (n + 1.0) * np.maximum(depth, 0.0) * self.contact_radius(depth)

    def contact_radius(self, depth: ArrayLike) -> Real:
        """(depth/(beta c))^(1/n), m."""
        return (np.maximum(depth, 0.0) / self._steepness) ** (1.0 / self.exponent)

    def depth(self, contact_radius: ArrayLike) -> Real:
        """beta c a^n, m."""
        return self._steepness * np.asarray(contact_radius) ** self.exponent

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """n beta c a^(n-1)."""
        return self.exponent * self._steepness * np.asarray(contact_radius) ** (self.exponent - 1.0)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> Array:
        """p/E* = (n beta c/pi) a^(n-1) w 2F1(1, 1-n/2; 3/2; w^2) with w^2 = 1 - r^2/a^2; infinite at a cone's tip."""
        from scipy.special import hyp2f1

        r = np.abs(np.asarray(radius, dtype=float))
        square = 1.0 - np.divide(r, contact_radius, out=np.ones_like(r), where=r < contact_radius) ** 2
        series = hyp2f1(1.0, 1.0 - 0.5 * self.exponent, 1.5, square)
        return np.asarray(self.depth_slope(contact_radius) / pi * np.sqrt(square) * series)
