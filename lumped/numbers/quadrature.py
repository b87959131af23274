"""Gauss-Legendre quadrature, its nodes found once."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@cache
def gauss(points: int) -> tuple[Array, Array]:
    """Nodes and weights on (0, 1), each of shape (points,)."""
    nodes, weights = np.polynomial.legendre.leggauss(points)
    return 0.5 * (nodes + 1.0), 0.5 * weights
