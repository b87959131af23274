"""Boussinesq 1885: the flat-ended rigid cylinder, whose contact area is its own."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.load_curves.base import LoadCurve
from lumped.load_curves.hertz import HertzImpact


@dataclass(frozen=True)
class FlatPunch(LoadCurve):
    """F = 2 E* R depth, a = R at every depth above zero."""

    radius: float

    def force(self, depth: ArrayLike) -> Any:
        """F/E*, m^2."""
        return 2.0 * self.radius * np.maximum(depth, 0.0)

    def contact_radius(self, depth: ArrayLike) -> Any:
        """R, m, from the first touch on."""
        if isinstance(depth, float):
            return self.radius if depth >= 0.0 else 0.0
        return np.where(np.asarray(depth) >= 0.0, self.radius, 0.0)

    def depth(self, contact_radius: ArrayLike) -> Any:
        """Zero inside the rim, infinite beyond: no depth makes the area grow."""
        return np.where(np.asarray(contact_radius) <= self.radius, 0.0, np.inf)

    def depth_slope(self, contact_radius: ArrayLike) -> Any:
        """Infinite at the rim."""
        return np.where(np.asarray(contact_radius) < self.radius, 0.0, np.inf)

    def energy(self, depth: ArrayLike) -> NDArray[np.float64]:
        """E* R depth^2."""
        return np.asarray(self.radius * np.maximum(np.asarray(depth, dtype=float), 0.0) ** 2)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> NDArray[np.float64]:
        """p/(E* depth/R) = 1/(pi sqrt(1 - r^2/R^2)), here per unit of depth/R; infinite at the rim."""
        ratio = np.abs(np.asarray(radius, dtype=float)) / self.radius
        with np.errstate(divide="ignore"):
            inside = 1.0 / (math.pi * np.sqrt(np.maximum(1.0 - ratio**2, 0.0)))
        return np.where(ratio <= 1.0, inside, 0.0)

    def impact(self, modulus: float, mass: float, velocity: float) -> HertzImpact:
        """Scales of the elastic impact: half a period of mass and spring; modulus in Pa."""
        stiffness = 2.0 * modulus * self.radius
        depth = velocity * math.sqrt(mass / stiffness)
        return HertzImpact(math.pi * math.sqrt(mass / stiffness), depth, stiffness * depth, self.radius)
