"""Radau's collocation in time: an integrator as numbers.

Stages at the right-hand Radau points, order 2 s - 1, stiffly accurate and L-stable: Hairer and Wanner, Solving
Ordinary Differential Equations II, IV.5, ISBN 978-3-642-05220-0. A force like depth^(3/2) is not smooth in time where
the depth is zero: steps after a touch run in the p-th root of the time since then, a step that ends at depth zero in
that of the time left, in which it is smooth.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev, legendre
from numpy.typing import NDArray

from lumped.numbers import Array, Real

STAGES = 8  # default: Radau points of a step
# Safety: least and most of the next step over this one, and the share of what is allowed.
SHORTEST, LONGEST, CAUTION = 0.1, 5.0, 0.8


class Nodes(NamedTuple):
    """Points in (0, 1], shape (s,), the last one 1, and matrices (s, s) that act on values there.

    `points` are shares of the step's time, `pace` is the time's slope over the place, which goes from 0 to 1 over the
    step: the p-th root of the time since `begun` step lengths before the step, or, `mirrored`, until its end. `once`
    integrates over the place from zero to each point, `twice` over the place and then over the time; `weights` (s,)
    over the whole step. `series` turns values into Legendre coefficients in the place on [0, 1], `first`, shape
    (s, s + 1), those into the ones of the integral. `leaving` (s,) is the slope over the place at the last point.
    """

    power: int
    begun: float
    mirrored: bool
    points: Array
    pace: Array
    once: Array
    twice: Array
    weights: Array
    series: Array
    first: Array
    leaving: Array
    places: Array

    def graded(self, power: int, begun: float, mirrored: bool = False) -> Nodes:
        """The same places, run through at another pace."""
        points, pace = paced(self.places, power, begun, mirrored)
        points[-1] = 1.0
        twice = self.once @ (pace[:, None] * self.once)
        return self._replace(power=power, begun=begun, mirrored=mirrored, points=points, pace=pace, twice=twice)

    def again(self, rough: float) -> float:
        """The share of its length for a step that begins at the same time: this one is so much rougher than allowed.

        A mirrored one leaves as much of its end to another, and takes what is before.
        """
        low, high = self.roots
        share = float((low + self._longer(rough) * (high - low)) ** self.power - self.begun)
        return 1.0 - share if self.mirrored else share

    def following(self, rough: float) -> float:
        """The share of its length for the step that follows: this one is so much rougher than allowed, or smoother."""
        low, high = self.roots
        return float((high + self._longer(rough) * (high - low)) ** self.power - (1.0 + self.begun))

    def _longer(self, rough: float) -> float:
        """How much longer the root of a step may be: the last Legendre terms fall with the power s of it."""
        ratio = CAUTION * rough ** (-1.0 / STAGES) if rough > 0.0 else LONGEST
        return float(min(max(ratio, SHORTEST ** (1.0 / self.power)), LONGEST ** (1.0 / self.power)))

    @property
    def roots(self) -> tuple[float, float]:
        """The root at the step's start and at its end, in units of the one which its length has."""
        return self.begun ** (1.0 / self.power), (1.0 + self.begun) ** (1.0 / self.power)


@cache
def radau(count: int) -> Nodes:
    """The `count` right-hand Radau points: zeros of P_s - P_(s-1), mapped to (0, 1]."""
    difference = np.zeros(count + 1)
    difference[-1], difference[-2] = 1.0, -1.0
    zeros = np.sort(np.real(legendre.legroots(difference)))  # all of them real; complex numbers from numpy 2.5 on
    # the eigenvalues behind the roots leave a few last digits
    zeros -= legendre.legval(zeros, difference) / legendre.legval(zeros, legendre.legder(difference))
    zeros[-1] = 1.0
    series = np.array(np.linalg.inv(legendre.legvander(zeros, count - 1)), dtype=float)
    # d/dx of the series in x in [-1, 1] is twice that over the step's share in [0, 1]
    first = 0.5 * np.array([legendre.legint(row, lbnd=-1.0) for row in np.eye(count)])
    ends = np.array([2.0 * legendre.legval(1.0, legendre.legder(row)) for row in np.eye(count)])
    once = legendre.legvander(zeros, count) @ first.T @ series
    points: Array = 0.5 * (1.0 + zeros)
    pace = np.ones(count)
    last, leaving = np.array(once[-1]), np.array(ends @ series)
    return Nodes(1, 0.0, False, points, pace, once, once @ once, last, series, first, leaving, points)


NODES = radau(STAGES)


def paced(place: Array, power: Real, begun: Real, mirrored: Real) -> tuple[Array, Array]:
    """Shares of a step's time at places in it, and the time's slope over the place there; all of one shape."""
    low, high = begun ** (1.0 / power), (1.0 + begun) ** (1.0 / power)
    root = low + (high - low) * np.where(mirrored, 1.0 - place, place)
    share = root**power - begun
    return np.where(mirrored, 1.0 - share, share), np.asarray(power * (high - low) * root ** (power - 1))


def place_of(share: Array, power: Array, begun: Array, mirrored: NDArray[np.bool_]) -> Array:
    """Places in steps of these nodes where shares of their time have passed, all of one shape."""
    root = (np.where(mirrored, 1.0 - share, share) + begun) ** (1.0 / power)
    low, high = begun ** (1.0 / power), (1.0 + begun) ** (1.0 / power)
    place = (root - low) / (high - low)
    return np.where(mirrored, 1.0 - place, place)


def through_zero(share: Array, count: int = STAGES) -> Array:
    """Weights, shape (n, s + 1), of the values at zero and at the points in the polynomial through them all."""
    return np.asarray(legendre.legvander(2.0 * share - 1.0, count) @ _legendre_through_zero(count))


@cache
def _legendre_through_zero(count: int) -> Array:
    """The matrix (n + 1, n + 1) from values at zero and at n points to the Legendre coefficients of the polynomial."""
    return np.asarray(np.linalg.inv(legendre.legvander(2.0 * np.append(0.0, radau(count).points) - 1.0, count)))


@cache
def chebyshev_through_zero(count: int) -> Array:
    """The matrix (n + 1, n + 1) from values at zero and at n points to the Chebyshev coefficients of the polynomial."""
    basis = chebyshev.chebvander(2.0 * np.append(0.0, radau(count).points) - 1.0, count)
    return np.asarray(np.linalg.inv(basis), dtype=float)
