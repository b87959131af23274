"""Sneddon 1948: the cone."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, radians, tan
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import BadInput, Fault
from lumped.load_curves.half_space import HalfSpaceCurve
from lumped.numbers import Array, Real


@dataclass(frozen=True)
class ConeCurve(HalfSpaceCurve):
    """depth = (pi/2) a tan(theta), F = (2/pi) E* depth^2/tan(theta).

    `angle` theta lies between the face and the undeformed surface, degrees, above 0 and below 90; raises BadInput.
    Doi 10.1016/0020-7225(65)90019-4.
    """

    angle: float
    closed: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if not 0.0 < self.angle < 90.0:
            message = f"must lie between 0 and 90 degrees, is {self.angle}: at 0 use a punch, at 90 there is no face"
            raise BadInput(Fault("cone", "angle", message))

    @property
    def steepness(self) -> float:
        """tan(theta)."""
        return tan(radians(self.angle))

    def force(self, depth: ArrayLike) -> Real:
        """F/E*, m^2."""
        return 2.0 / (pi * self.steepness) * np.maximum(depth, 0.0) ** 2

    def contact_radius(self, depth: ArrayLike) -> Real:
        """2 depth/(pi tan(theta)), m."""
        return 2.0 / (pi * self.steepness) * np.maximum(depth, 0.0)

    def depth(self, contact_radius: ArrayLike) -> Real:
        """(pi/2) a tan(theta), m."""
        return 0.5 * pi * self.steepness * np.asarray(contact_radius)

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """(pi/2) tan(theta)."""
        return np.full_like(np.asarray(contact_radius, dtype=float), 0.5 * pi * self.steepness)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> Array:
        """p/E* = (tan(theta)/2) arcosh(a/r), infinite at the tip."""
        r = np.abs(np.asarray(radius, dtype=float))
        with np.errstate(divide="ignore"):
            ratio = np.divide(contact_radius, r, out=np.ones_like(r), where=r < contact_radius)
        return np.asarray(0.5 * self.steepness * np.arccosh(ratio))
