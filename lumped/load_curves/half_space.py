"""The elastic half-space under a convex axisymmetric profile: what all its closed forms share; two on one another."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lumped.load_curves.base import GAUSS_POINTS, LoadCurve
from lumped.numbers import Array, Real, gauss

STEPS, LAST_STEP = 60, 1e-12  # of Newton's method; the step after that is rounding


class HalfSpaceCurve(LoadCurve):
    """A curve of the half-space. Its depth(a) is the one-dimensional profile g(a) = a int_0^a h'(r)/sqrt(a^2-r^2) dr
    of the indenter (Sneddon 1965, doi 10.1016/0020-7225(65)90019-4).
    """

    def dforce_ddepth(self, depth: ArrayLike) -> Real:
        """2 a."""
        return 2.0 * self.contact_radius(depth)

    def energy(self, depth: ArrayLike) -> Array:
        """Work of indentation int_0^depth F d depth = depth (F - a depth) + int_0^a depth(x)^2 dx."""
        d = np.maximum(np.asarray(depth, dtype=float), 0.0)
        a = np.asarray(self.contact_radius(d))
        nodes, weights = gauss(GAUSS_POINTS)
        inner = a * (np.square(self.depth(a[..., None] * nodes)) @ weights)
        return np.asarray(d * (self.force(d) - a * d) + inner)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> Array:
        """Pressure p(r)/E* = (1/pi) int_r^a depth'(x)/sqrt(x^2-r^2) dx, zero outside the contact.

        Popov and Hess 2015, ISBN 978-3-642-53876-6.
        """
        r = np.minimum(np.abs(np.asarray(radius, dtype=float)), contact_radius)
        reach = np.sqrt(np.maximum(contact_radius**2 - r**2, 0.0))
        nodes, weights = gauss(GAUSS_POINTS)
        s = reach[..., None] * nodes
        x = np.hypot(s, r[..., None])
        slope_over_x = np.divide(self.depth_slope(x), x, out=np.zeros_like(x), where=x > 0.0)
        return np.asarray(reach * (slope_over_x @ weights) / np.pi)


@dataclass(frozen=True)
class TwoProfiles(HalfSpaceCurve):
    """Two convex profiles on one another: heights add, so at one contact radius depths and forces add.

    E* is that of both materials together.
    """

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
