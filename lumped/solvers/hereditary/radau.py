"""Radau's collocation with the start of its interval: what polynomials through it and the nodes need."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from lumped.solvers.point import nodes as collocation

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
    """The tables for this number of nodes."""
    nodes = collocation.radau(points)
    basis = chebyshev.chebvander(2.0 * np.append(0.0, nodes.points) - 1.0, points)
    return Radau(nodes.points, nodes.once, np.asarray(np.linalg.inv(basis), dtype=float))


@cache
def slopes(count: int) -> Array:
    """The matrix (n, n) from `count` coefficients to those of the derivative over (-1, 1)."""
    return np.pad(chebyshev.chebder(np.eye(count), axis=0), ((0, 1), (0, 0)))
