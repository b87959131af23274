"""The load curve of a rigid cylinder inside an elastic ring, in plane strain, per unit length."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import exp, log
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import NotReached
from lumped.load_curves.base import GAUSS_POINTS, LoadCurve
from lumped.load_curves.ring_contact import RingContact
from lumped.load_curves.tabulated import Array, evaluate, panel, tested_place
from lumped.numbers import Real
from lumped.numbers.quadrature import gauss

# Panels by the logarithm of the depth over its limit: the deeper half, and a decade each below it.
EDGES = -log(2.0) - log(10.0) * np.arange(-1.0, 18.0)
EDGES[0] = 0.0
ACCURACY, REFINEMENT = 1e-8, 1.5


@dataclass(frozen=True)
class RodInRing(RingContact, LoadCurve):
    """F is the component along the motion, the contact radius the half-length of the inner arc that is touched.

    While the cylinder's arc is the exact one, F is not the slope of a stored energy: the motion turns the overlap a
    little further than cos(theta). Depths stay below thickness and radius; below 1e-17 of them all is 0.
    Raises BadInput, or NotReached where two resolutions differ by more than 1e-8 or the contact goes all the way round.
    """

    accuracy: ClassVar[float] = ACCURACY

    def force(self, depth: ArrayLike) -> Real:
        """F/E* per unit length, m."""
        return self._at(depth)[1]

    def contact_radius(self, depth: ArrayLike) -> Real:
        """Half-length of the inner arc touched, m."""
        return self._at(depth)[0]

    def dforce_ddepth(self, depth: ArrayLike) -> Real:
        """d(F/E*)/d depth per unit length."""
        return self._at(depth)[2]

    def force_and_slope(self, depth: ArrayLike) -> tuple[Real, Real]:
        """F/E* and dF/d depth at a depth."""
        _, force, slope, _ = self._at(depth)
        return force, slope

    def depth(self, contact_radius: ArrayLike) -> Real:
        """The least depth with this half-length of arc, m, from the equation itself; infinite where none has it."""
        half_length = np.asarray(contact_radius, dtype=float)
        depths = [self.depth_at(float(b) / self.inner_radius) if b > 0.0 else 0.0 for b in half_length.ravel()]
        return np.reshape(depths, half_length.shape)

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """d depth / d half-length of arc."""
        depth = np.asarray(self.depth(contact_radius))
        half_length, _, _, exponent = self._at(depth)
        product = half_length * exponent
        return np.divide(depth, product, out=np.zeros_like(depth), where=product > 0.0)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> NDArray[np.float64]:
        """p/E* at distances along the inner arc, from the equation itself."""
        return self.pressure_at(radius, float(self.depth(contact_radius)))

    def pressure_at(self, radius: ArrayLike, depth: float) -> NDArray[np.float64]:
        """p/E* at distances along the inner arc and a depth."""
        self.check_depth(depth)
        if depth <= 0.0:
            return np.zeros_like(np.asarray(radius, dtype=float))
        here = self.pressed(depth, 1.0)
        return here.collocation.at(here.q, np.asarray(radius, dtype=float) / here.half_width)

    def energy(self, depth: ArrayLike) -> NDArray[np.float64]:
        """Work of indentation int_0^depth F d depth."""
        d = np.maximum(np.asarray(depth, dtype=float), 0.0)
        nodes, weights = gauss(GAUSS_POINTS)
        return np.asarray(d * (self.force(d[..., None] * nodes**2) @ (2.0 * nodes * weights)))

    def _at(self, depth: ArrayLike) -> Array:
        """Half-length, F/E*, its slope and dln(half-length)/dln(depth), shape (4, ...); all 0 without depth."""
        self.check_depth(depth)
        d = np.asarray(depth, dtype=float)
        place = np.log(d / self.depth_limit, out=np.full(d.shape, -np.inf), where=d > 0.0).ravel()
        answer = np.zeros((4, d.size))
        for index in np.unique(np.searchsorted(-EDGES, -place)):
            if 0 < index < EDGES.size:
                here = (place < EDGES[index - 1]) & (place >= EDGES[index])
                values, slopes = evaluate(_panel(self, index)[None], EDGES[[index, index - 1]], place[here])
                answer[:, here] = np.concatenate([np.exp(values), slopes[:1]])
        return answer.reshape(4, *d.shape)


@lru_cache(maxsize=256)
def _panel(ring: RodInRing, index: int) -> Array:
    """Logarithms of half-length, F/E* and dF/d depth over ln(depth/limit), shape (POINTS, 2, 3), certified."""

    def sample(place: float, refinement: float = 1.0) -> Array:
        here = ring.pressed(ring.depth_limit * exp(place), refinement)
        return np.log([here.half_width, here.force, 1.0 / here.compliance])

    low, high = (float(edge) for edge in EDGES[[index, index - 1]])
    table, place = panel(low, high, sample), tested_place(low, high)
    kept, _ = evaluate(table[None], np.array([low, high]), np.array([place]))
    error = float(np.abs(kept[1:, 0] - sample(place, REFINEMENT)[1:]).max())
    if not error <= ACCURACY:
        depth = ring.depth_limit * exp(place)
        raise NotReached(f"{ring} at a depth of {depth:g} m: two resolutions differ by {error:.1e}")
    return table
