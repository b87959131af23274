"""Radau's collocation as tables of numbers: nodes, integrals up to them, and the polynomial through them.

Hairer and Wanner, Solving Ordinary Differential Equations II, section IV.5, doi 10.1007/978-3-642-05221-7.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import chebyshev, legendre
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Radau:
    """Collocation with N nodes on (0, 1], the last one at 1: stiff decays die out as they should.

    `nodes` (N,); `integral` (N, N) takes values at the nodes to integrals from 0 to them; `series` (N+1, N+1)
    takes values at 0 and at the nodes to coefficients of Chebyshev polynomials over the interval.
    """

    nodes: Array
    integral: Array
    series: Array

    @property
    def places(self) -> Array:
        """0 and the nodes, shape (N+1,)."""
        return np.append(0.0, self.nodes)


@cache
def radau(points: int) -> Radau:
    """The tables for this number of nodes: the zeros of P_{N-1} - P_N on (-1, 1]."""
    x = legendre.legroots([0.0] * (points - 1) + [1.0, -1.0])
    x[-1] = 1.0
    degrees = np.eye(points)
    integrals = np.array([legendre.legval(x, legendre.legint(degree, lbnd=-1)) for degree in degrees]).T
    integral = 0.5 * integrals @ np.linalg.inv(legendre.legvander(x, points - 1))
    series = np.linalg.inv(chebyshev.chebvander(np.append(-1.0, x), points))
    return Radau(0.5 * (x + 1.0), integral, series)


@cache
def slopes(count: int) -> Array:
    """The matrix (n, n) from `count` coefficients to those of the derivative over (-1, 1)."""
    return np.pad(chebyshev.chebder(np.eye(count), axis=0), ((0, 1), (0, 0)))
