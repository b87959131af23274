"""Galin 1946 and Sneddon 1965 for the profile c r^n: doi 10.1016/0020-7225(65)90019-4."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lumped.load_curves.base import LoadCurve
from lumped.load_curves.hertz import HertzImpact


@dataclass(frozen=True)
class Power(LoadCurve):
    """depth = c kappa a^n, kappa = sqrt(pi) Gamma(n/2 + 1)/Gamma((n + 1)/2); F = E* D depth^(1 + 1/n).

    `coefficient` c in m^(1-n), `exponent` n >= 1: the cone at 1, the parabola at 2, the flat punch at infinity.
    """

    coefficient: float
    exponent: float

    @property
    def alpha(self) -> float:
        """The exponent 1 + 1/n of the force."""
        return 1.0 + 1.0 / self.exponent

    @property
    def geometry_factor(self) -> float:
        """D = 2 n/(n + 1) (c kappa)^(-1/n), m^(2 - alpha): Table 1's geometry factor."""
        return 2.0 * self.exponent / (self.exponent + 1.0) * math.pow(self._steepness, -1.0 / self.exponent)

    def force(self, depth: ArrayLike) -> Any:
        """F/E*, m^2."""
        return self.geometry_factor * np.maximum(depth, 0.0) ** self.alpha

    def contact_radius(self, depth: ArrayLike) -> Any:
        """(depth/(c kappa))^(1/n), m."""
        if isinstance(depth, float):
            return float((max(depth, 0.0) / self._steepness) ** (1.0 / self.exponent))
        return (np.maximum(depth, 0.0) / self._steepness) ** (1.0 / self.exponent)

    def depth(self, contact_radius: ArrayLike) -> Any:
        """c kappa a^n, m."""
        return self._steepness * np.asarray(contact_radius) ** self.exponent

    def depth_slope(self, contact_radius: ArrayLike) -> Any:
        """n c kappa a^(n - 1)."""
        return self.exponent * self._steepness * np.asarray(contact_radius) ** (self.exponent - 1.0)

    def impact(self, modulus: float, mass: float, velocity: float) -> HertzImpact:
        """Scales of the elastic impact on a modulus, Pa: it lasts 2 (d_m/v) int_0^1 dx/sqrt(1 - x^(alpha + 1))."""
        power = self.alpha + 1.0
        inertia = mass / modulus / self.geometry_factor
        depth = math.pow(0.5 * power * inertia * velocity**2, 1.0 / power)
        integral = math.sqrt(math.pi) * math.gamma(1.0 + 1.0 / power) / math.gamma(0.5 + 1.0 / power)
        force = modulus * self.geometry_factor * math.pow(depth, self.alpha)
        return HertzImpact(2.0 * depth / velocity * integral, depth, force, self.contact_radius(depth))

    @property
    def _steepness(self) -> float:
        """c kappa."""
        n = self.exponent
        return self.coefficient * math.sqrt(math.pi) * math.gamma(0.5 * n + 1.0) / math.gamma(0.5 * (n + 1.0))
