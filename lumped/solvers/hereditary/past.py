"""What the rebound has to know of the approach between an earlier time t1 and the turn t_m.

A memory of the depth with rate 1/tau, or with none, sees of that stretch
    Y(t1) = int_{t1}^{t_m} exp(-(t_m-s)/tau) d depth(s),
which is summed from the turn back and not taken as a difference: near the turn it is as small as (t_m - t1)^2, and all
of its digits count.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

from lumped.solvers.hereditary.path import Path

Array = NDArray[np.float64]
# The nodes of a piece integrate what fades by less than this power of e within it; a fade of FORGOTTEN leaves nothing.
RESOLVED, FORGOTTEN = 2.0, 40.0
NODES, WEIGHTS = (0.5 * (1.0 + leggauss(32)[0]), 0.5 * leggauss(32)[1])


@dataclass(frozen=True)
class Past:
    """The approach as a path over r = sqrt(t) up to its turn, its field of the velocity, and rates (J,)."""

    path: Path
    velocity: int
    rates: Array

    def rises(self, place: float, over: Array, weights: Array, known: Array) -> Array:
        """Y at places -sqrt(t1) `over`, (N,), from its values `known`, (J,), at a place before: shape (J, N).

        `weights`, (N, N), integrate from there what the nodes resolve.
        """
        rises = known[:, None] + self._faded(over, self.rates[:, None]) @ weights.T
        begun = self.age(place)
        steep = self.rates * (self.age(over[-1]) - begun) > RESOLVED
        for j in np.flatnonzero(steep & (self.rates * begun < FORGOTTEN)):
            rises[j] = known[j] + self._summed(place, over, float(self.rates[j]))
        return rises

    def _summed(self, place: float, over: Array, rate: float) -> Array:
        """What a fast memory gains from a place on to each of `over`, (N,): Gauss's rule over what it still sees."""
        earliest = max(place * place - FORGOTTEN / rate, 0.0)
        reach = np.minimum(over, -math.sqrt(earliest)) - place
        return reach * (self._faded(place + reach[:, None] * NODES, rate) @ WEIGHTS)

    def _faded(self, places: Array, rate: Array | float) -> Array:
        """-d Y / d place."""
        velocity = self.path.value(self.velocity, -places)
        return np.asarray(-2.0 * places * velocity * np.exp(-rate * self.age(places)))

    @property
    def turn(self) -> float:
        """t_m."""
        return self.path.end**2

    def age(self, places: Array | float) -> Array:
        """t_m - t1."""
        return np.asarray((self.path.end - places) * (self.path.end + places))
