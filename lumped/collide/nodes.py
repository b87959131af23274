"""Radau's collocation in time: an integrator as numbers.

Stages at the right-hand Radau points, order 2 s - 1, stiffly accurate and L-stable: Hairer and Wanner, Solving
Ordinary Differential Equations II, IV.5, ISBN 978-3-642-05220-0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

Array = NDArray[np.float64]
STAGES = 8


@dataclass(frozen=True, eq=False)
class Nodes:
    """Points in (0, 1], shape (s,), the last one 1, and matrices (s, s) that act on values there.

    `once` and `twice` integrate from zero to each point, once and twice; `weights` (s,) over the whole step;
    `series` turns values into Legendre coefficients on [0, 1]; `first` and `second`, shape (s, s + 1) and
    (s, s + 2), those coefficients into the ones of the integrals.
    """

    points: Array
    once: Array
    twice: Array
    weights: Array
    series: Array
    first: Array
    second: Array


@cache
def radau(count: int) -> Nodes:
    """The `count` right-hand Radau points: zeros of P_s - P_(s-1), mapped to (0, 1]."""
    difference = np.zeros(count + 1)
    difference[-1], difference[-2] = 1.0, -1.0
    zeros = np.sort(np.real(legendre.legroots(difference)))
    for _ in range(2):  # the eigenvalues behind the roots leave a few last digits
        zeros -= legendre.legval(zeros, difference) / legendre.legval(zeros, legendre.legder(difference))
    zeros[-1] = 1.0
    series: Array = np.linalg.inv(np.asarray(legendre.legvander(zeros, count - 1), dtype=np.float64))
    # d/dx of the series in x in [-1, 1] is twice that over the step's share in [0, 1]
    first = 0.5 * np.array([legendre.legint(row, lbnd=-1.0) for row in np.eye(count)])
    second = 0.25 * np.array([legendre.legint(row, m=2, lbnd=-1.0) for row in np.eye(count)])
    once = legendre.legvander(zeros, count) @ first.T @ series
    points = 0.5 * (1.0 + zeros)
    return Nodes(points, once, once @ once, np.array(once[-1]), series, first, second)


def through_zero(share: Array, count: int = STAGES) -> Array:
    """Weights, shape (n, s + 1), of the values at zero and at the points in the polynomial through them all."""
    places = np.concatenate([[0.0], radau(count).points])
    basis = legendre.legvander(2.0 * share - 1.0, count)
    return np.asarray(basis @ np.linalg.inv(legendre.legvander(2.0 * places - 1.0, count)))
