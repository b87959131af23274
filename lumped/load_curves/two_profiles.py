"""Two convex profiles on one another: the half-space under the sum of their heights."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lumped.load_curves.base import LoadCurve
from lumped.load_curves.half_space import HalfSpaceCurve
from lumped.numbers import Real

STEPS, LAST_STEP = 60, 1e-12  # the step after that is rounding


@dataclass(frozen=True)
class TwoProfiles(HalfSpaceCurve):
    """Heights add, so at one contact radius depths and forces add; E* is that of both materials together."""

    first: LoadCurve
    second: LoadCurve

    @property
    def extent(self) -> float:
        """The smaller of the two, m."""
        return min(self.first.extent, self.second.extent)

    def force(self, depth: ArrayLike) -> Real:
        """F/E*, m^2."""
        return self.force_at(self.contact_radius(depth))

    def force_at(self, contact_radius: ArrayLike) -> Real:
        """F1(a) + F2(a), m^2."""
        return self.first.force_at(contact_radius) + self.second.force_at(contact_radius)

    def depth(self, contact_radius: ArrayLike) -> Real:
        """d1(a) + d2(a), m."""
        return self.first.depth(contact_radius) + self.second.depth(contact_radius)

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """d1'(a) + d2'(a)."""
        return self.first.depth_slope(contact_radius) + self.second.depth_slope(contact_radius)

    def contact_radius(self, depth: ArrayLike) -> Real:
        """a with d1(a) + d2(a) = depth, m, by Newton: the sum is convex, and each profile alone would be wider."""
        asked = np.asarray(depth, dtype=float)
        wanted = asked[asked > 0.0]
        radius = np.minimum(self.first.contact_radius(wanted), self.second.contact_radius(wanted))
        with np.errstate(invalid="ignore"):  # of an infinite depth, which a solver asks that has lost its way
            for _ in range(STEPS):
                step = (self.depth(radius) - wanted) / self.depth_slope(radius)
                radius = radius - step
                if np.all(np.abs(step) <= LAST_STEP * radius):
                    break
        found = np.zeros_like(asked)
        found[asked > 0.0] = radius
        return found
