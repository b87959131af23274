"""The half-space under a profile whose slope is linear piece by piece: a table of heights, a flat end with round edge.

Its slope is h'(r) = s + sum_k c_k (r - t_k)_+, a cone of slope s whose face bends by c_k from the radius t_k on; what
each bend adds to Sneddon's integrals is in closed form (for a single one Ciavarella 1999, doi 10.1093/imamat/63.2.145).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from lumped.load_curves.base import GAUSS_POINTS
from lumped.load_curves.half_space import KnownByRadius
from lumped.numbers import Array, Real, gauss

# tan x - x = x^3/3 + 2x^5/15 + ...: rounding, below 0.15 the difference itself would lose digits.
SERIES = (1 / 3, 2 / 15, 17 / 315, 62 / 2835, 1382 / 155925, 21844 / 6081075, 929569 / 638512875)
SERIES_BELOW = 0.15  # rounding: an angle
NEAR = 1e-9  # rounding: of the contact radius, places closer to a bend than that stand beside it


class _Bends(NamedTuple):
    """What a contact of radius a sees of a bend at t = a cos(angle): sqrt(a^2 - t^2), and that less t angle, m."""

    reach: Array
    angle: Array
    rest: Array


@dataclass(frozen=True)
class BentCurve(KnownByRadius):
    """Radii t_k >= 0, ascending, m, and bends c_k, 1/m, of one length; `slope` s >= 0. The profile is convex."""

    radii: tuple[float, ...]
    bends: tuple[float, ...]
    slope: float = 0.0

    @property
    def breaks(self) -> tuple[float, ...]:
        """t_k, m."""
        return self.radii

    @property
    def least_radius(self) -> float:
        """Contact radius of the first touch, m: that of a flat end."""
        return self.radii[0] if self.slope == 0.0 else 0.0

    @property
    def root_before(self) -> float:
        """-pi s/(2 c) of a tip of slope s with a bend c on the axis, m."""
        tipped = self.slope > 0.0 and 0.0 in self.radii
        return -0.5 * np.pi * self.slope / self.bends[self.radii.index(0.0)] if tipped else float("-inf")

    def depth(self, contact_radius: ArrayLike) -> Real:
        """a [pi/2 s + sum c_k (w_k - t_k angle_k)], w_k = sqrt(a^2 - t_k^2), angle_k = arccos(t_k/a), m."""
        return self.depth_and_slope(np.asarray(contact_radius, dtype=float))[0]

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """pi/2 s + sum c_k (2 w_k - t_k angle_k)."""
        return self.depth_and_slope(np.asarray(contact_radius, dtype=float))[1]

    def depth_and_slope(self, contact_radius: Array) -> tuple[Array, Array]:
        """Both of what is seen once."""
        seen, slope, bends = self._seen(contact_radius), 0.5 * np.pi * self.slope, np.array(self.bends)
        return contact_radius * (slope + seen.rest @ bends), slope + (seen.reach + seen.rest) @ bends

    def force_at(self, contact_radius: ArrayLike) -> Real:
        """F/E* = pi/2 s a^2 + sum c_k [4/3 w_k^3 + t_k^2 w_k - t_k a^2 angle_k], m^2."""
        a = np.asarray(contact_radius, dtype=float)
        seen, t = self._seen(a), np.array(self.radii)
        # t^2 w - t a^2 angle = t^2 (w - t angle) - w^2 t angle: no digit is lost where the edge is near the bend
        added = seen.reach**2 * (4.0 / 3.0 * seen.reach - t * seen.angle) + t**2 * seen.rest
        return 0.5 * np.pi * self.slope * a**2 + added @ np.array(self.bends)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> Array:
        """p/E* = s/2 arcosh(a/r) + (1/pi) sum c_k int (2 w_k(x) - t_k angle_k(x))/sqrt(x^2 - r^2) dx.

        From max(r, t_k) to a, by Gauss over the angle in which both roots are smooth; infinite at a tip.
        """
        r = np.abs(np.asarray(radius, dtype=float))
        inside, t = r < contact_radius, np.array(self.radii)
        with np.errstate(divide="ignore"):
            ratio = np.divide(contact_radius, r, out=np.ones_like(r), where=inside)
        cone = 0.5 * self.slope * np.arccosh(ratio) if self.slope else np.zeros_like(r)
        place = np.minimum(r, contact_radius)[..., None]
        outer, inner = np.maximum(place, t), np.minimum(place, t)
        apart = np.maximum(np.sqrt(outer**2 - inner**2), NEAR * contact_radius)
        end = np.arcsinh(np.sqrt(np.maximum(contact_radius**2 - outer**2, 0.0)) / apart)
        nodes, weights = gauss(GAUSS_POINTS)
        turn = end[..., None] * nodes
        near, far = (apart[..., None] * of(turn) for of in (np.sinh, np.cosh))  # from the outer, the inner place
        reach = np.where((t >= place)[..., None], near, far)
        angle = np.arctan2(reach, t[:, None])
        share = reach / np.hypot(near, outer[..., None])  # dx over the other root
        rows = end * (((2.0 * reach - t[:, None] * angle) * share) @ weights)
        return np.where(inside, cone + rows @ np.array(self.bends) / np.pi, 0.0)

    def _seen(self, contact_radius: Array) -> _Bends:
        """Of contact radii of any shape, m, each array (..., bends)."""
        a, t = np.maximum(contact_radius, 0.0)[..., None], np.array(self.radii)
        reach = np.sqrt(np.maximum((a - t) * (a + t), 0.0))
        angle = np.where(reach > 0.0, np.arctan2(reach, t), 0.0)
        square = angle * angle
        series = SERIES[-1] * square + SERIES[-2]
        for coefficient in SERIES[-3::-1]:
            series = series * square + coefficient
        rest = np.where(angle < SERIES_BELOW, t * angle * square * series, reach - t * angle)
        return _Bends(reach, angle, rest)
