"""The elastic half-space under a convex axisymmetric profile: what all its closed forms share; two on one another."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from lumped.load_curves.base import GAUSS_POINTS, LoadCurve
from lumped.numbers import Array, Real, gauss

DOUBLINGS = 60  # of a contact radius: further than any accepted depth goes
STEPS, LAST_STEP = 60, 1e-12  # of Newton's method; the step after that is rounding
HALVED = 0.5  # work: of two steps ago, what a step of Newton's method may be: nearly all are much shorter


class HalfSpaceCurve(LoadCurve):
    """A curve of the half-space. Its depth(a) is the one-dimensional profile g(a) = a int_0^a h'(r)/sqrt(a^2-r^2) dr
    of the indenter (Sneddon 1965, doi 10.1016/0020-7225(65)90019-4).
    """

    @abstractmethod
    def force(self, depth: ArrayLike) -> Real:
        """F/E*, m^2."""

    def force_and_slope(self, depth: ArrayLike) -> tuple[Real, Real]:
        """F/E*, m^2, and 2 a, m."""
        return self.force(depth), 2.0 * self.contact_radius(depth)

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


class KnownByRadius(HalfSpaceCurve):
    """A curve whose depth and force are known over the contact radius; the radius of a depth is found by Newton."""

    @abstractmethod
    def force_at(self, contact_radius: ArrayLike) -> Real:
        """F/E* at a contact radius, m^2."""

    def wider(self, depth: Array) -> Array:
        """Contact radii, m, not below those of depths above zero, m, (n,): from the last break on, doubled."""
        radius = np.full_like(depth, self.breaks[-1] or 1.0)
        for _ in range(DOUBLINGS):
            short = self.depth(radius) < depth
            if not short.any():
                break
            radius = np.where(short, 2.0 * radius, radius)
        return radius

    def force(self, depth: ArrayLike) -> Real:
        """F/E*, m^2."""
        return self.force_at(self.contact_radius(depth))

    def force_and_slope(self, depth: ArrayLike) -> tuple[Real, Real]:
        """Of one contact radius: F/E*, m^2, and 2 a, m."""
        radius = self.contact_radius(depth)
        return self.force_at(radius), 2.0 * radius

    def depth_and_slope(self, contact_radius: Array) -> tuple[Array, Array]:
        """depth(a), m, and its slope at contact radii, m, (n,)."""
        return self.depth(contact_radius), self.depth_slope(contact_radius)

    def contact_radius(self, depth: ArrayLike) -> Real:
        """a with depth(a) = depth, m: Newton's steps, and the middle of the places around it where one leaves them.

        From the logarithm of the depth to that of what is touched beyond the first: powers are straight there. Where a
        profile turns steep at once, steps go to and fro across the turn: one not half as long as that before the last
        goes to the middle too.
        """
        asked, least = np.asarray(depth, dtype=float), self.least_radius
        wanted = asked[asked > 0.0]
        radius = self.wider(wanted)
        low, high = np.full_like(radius, least), radius
        last = before_last = np.full_like(radius, np.inf)
        with np.errstate(all="ignore"):  # of an infinite depth, which a solver asks that has lost its way
            for _ in range(STEPS):
                (reached, slope), before, beyond = self.depth_and_slope(radius), radius, radius - least
                low, high = np.where(reached < wanted, radius, low), np.where(reached > wanted, radius, high)
                radius = least + beyond * (wanted / reached) ** (reached / (beyond * slope))
                # with nothing beyond, where the exponent is no number, it is the first touch to rounding
                step = np.abs(radius - before)
                good = (radius >= low) & (radius <= high) & (step <= HALVED * before_last)
                good |= (step <= LAST_STEP * radius) | (beyond == 0.0)
                radius = np.where(good, np.fmax(radius, least), 0.5 * (low + high))
                before_last, last = last, np.abs(radius - before)
                if np.all(last <= LAST_STEP * radius):
                    break
        found = np.full_like(asked, self.least_radius)
        found[asked > 0.0] = radius
        return found

    def energy(self, depth: ArrayLike) -> Array:
        """Work of indentation, as every half-space's, but from break to break."""
        d = np.maximum(np.asarray(depth, dtype=float), 0.0)
        a, starts = np.asarray(self.contact_radius(d)), np.array((0.0, *self.breaks))
        last = np.searchsorted(starts, a, side="right") - 1
        inner = self._before_breaks[last] + self._squared(starts[last], a)
        return np.asarray(d * (self.force_at(a) - a * d) + inner)

    @cached_property
    def _before_breaks(self) -> Array:
        """int_0^b depth(x)^2 dx up to zero and to every break b, m^3, (breaks + 1,)."""
        ends = np.array((0.0, 0.0, *self.breaks))
        return np.asarray(np.cumsum(self._squared(ends[:-1], ends[1:])))

    def _squared(self, start: Array, end: Array) -> Array:
        """int depth(x)^2 dx between places without a break between them, m^3, (n,)."""
        nodes, weights = gauss(GAUSS_POINTS)
        width = end - start
        x = start[..., None] + width[..., None] * nodes**2
        return np.asarray(width * (np.square(self.depth(x)) @ (2.0 * nodes * weights)))


@dataclass(frozen=True)
class TwoProfiles(KnownByRadius):
    """Two convex profiles on one another: heights add, so at one contact radius depths and forces add.

    E* is that of both materials together.
    """

    first: LoadCurve
    second: LoadCurve

    @property
    def extent(self) -> float:
        """The smaller of the two, m."""
        return min(self.first.extent, self.second.extent)

    def force_at(self, contact_radius: ArrayLike) -> Real:
        """F1(a) + F2(a), m^2."""
        return self.first.force_at(contact_radius) + self.second.force_at(contact_radius)

    def depth(self, contact_radius: ArrayLike) -> Real:
        """d1(a) + d2(a), m."""
        return self.first.depth(contact_radius) + self.second.depth(contact_radius)

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """d1'(a) + d2'(a)."""
        return self.first.depth_slope(contact_radius) + self.second.depth_slope(contact_radius)

    def wider(self, depth: Array) -> Array:
        """Each profile alone would be wider, m."""
        return np.asarray(np.minimum(self.first.contact_radius(depth), self.second.contact_radius(depth)))
