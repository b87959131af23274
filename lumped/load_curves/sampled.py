"""A load curve known at some depths alone: power laws that change smoothly from one to the next."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import BadInput, Fault
from lumped.load_curves.base import LoadCurve
from lumped.numbers import Array, Real

BISECTIONS = 120  # work: halvings of the depth's logarithm, whose 1400 they take far below rounding
TINY = 1e-300  # safety: m, in place of zero where a logarithm is taken


@dataclass(frozen=True)
class SampledCurve(LoadCurve):
    """Depths, m, ascending, with forces F/E* and contact radii, m: at least two of each.

    Between them and beyond, the logarithms of force and radius are cubics and straight lines in that of the depth.
    """

    depths: tuple[float, ...]
    forces: tuple[float, ...]
    radii: tuple[float, ...]

    def force_and_slope(self, depth: ArrayLike) -> tuple[Real, Real]:
        """F/E* and its slope, zero without depth."""
        return self._power(depth, self.forces)

    def contact_radius(self, depth: ArrayLike) -> Real:
        """a, m."""
        return self._power(depth, self.radii)[0]

    def depth(self, contact_radius: ArrayLike) -> Real:
        """The depth of a contact radius, m, by bisection in logarithms."""
        asked = np.maximum(np.asarray(contact_radius, dtype=float), 0.0)
        low, high = np.full_like(asked, np.log(TINY)), np.full_like(asked, -np.log(TINY))
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            wide = _line(middle, np.log(self.depths), np.log(self.radii))[0] > np.log(np.maximum(asked, TINY))
            low, high = np.where(wide, low, middle), np.where(wide, middle, high)
        return np.where(asked > 0.0, np.exp(0.5 * (low + high)), 0.0)

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """1/(da/d depth)."""
        return 1.0 / self._power(self.depth(contact_radius), self.radii)[1]

    def pressure(self, radius: ArrayLike, contact_radius: float) -> Array:
        """Raises BadInput: forces alone are known."""
        raise BadInput(Fault("load curve", "pressure", "sampled: only its forces are known"))

    def _power(self, depth: ArrayLike, values: tuple[float, ...]) -> tuple[Real, Real]:
        """A positive quantity and its slope over the depth, which at touch is the limit: a flat end has a stiffness."""
        known = np.maximum(np.asarray(depth, dtype=float), TINY)
        logarithm, exponent = _line(np.log(known), np.log(self.depths), np.log(values))
        value = np.exp(logarithm)
        return np.where(np.asarray(depth) > 0.0, value, 0.0), value / known * exponent


def _line(x: Array, places: Array, values: Array) -> tuple[Array, Array]:
    """Cubics through the values with the slopes of parabolas through three, straight beyond; and their slope."""
    slopes = np.gradient(values, places, edge_order=2 if len(places) > 2 else 1)
    inside = np.clip(x, places[0], places[-1])
    i = np.clip(np.searchsorted(places, inside) - 1, 0, len(places) - 2)
    step = places[i + 1] - places[i]
    t, rise = (inside - places[i]) / step, (values[i + 1] - values[i]) / step
    first, last = slopes[i] - rise, slopes[i + 1] - rise
    value = values[i] + step * t * (rise + (1.0 - t) * (first * (1.0 - t) - last * t))
    slope = rise + first * (1.0 - t) * (1.0 - 3.0 * t) - last * t * (2.0 - 3.0 * t)
    return value + slope * (x - inside), slope
