"""Chebyshev polynomials on panels, certified where nothing holds them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

Array = NDArray[np.float64]

POINTS = 14
COSINES = np.cos(np.pi * (np.arange(POINTS) + 0.5) / POINTS)
# Of the way from a panel's middle to its end: no node lies there.
TESTED_AT = 0.985


def panel(low: float, high: float, sample: Callable[[float], Array]) -> Array:
    """Coefficients of smooth functions and of their slopes on one panel, shape (POINTS, 2, m).

    `sample` gives the m functions at one place, shape (m,).
    """
    places = 0.5 * (low + high) + 0.5 * (high - low) * COSINES
    values = chebyshev.chebfit(COSINES, np.array([sample(float(place)) for place in places]), POINTS - 1)
    slopes = np.concatenate([chebyshev.chebder(values), np.zeros((1, values.shape[1]))])
    return np.stack([values, slopes * 2.0 / (high - low)], axis=1)


def tested_place(low: float, high: float) -> float:
    """Where a panel is to be certified."""
    return 0.5 * (low + high) + 0.5 * (high - low) * TESTED_AT


def evaluate(tables: Array, edges: Array, place: Array) -> tuple[Array, Array]:
    """Functions and slopes at places, each of shape (m, n), from panels between ascending edges.

    `tables` has shape (k, POINTS, 2, m), `edges` (k+1,), `place` (n,); the outer panels go on beyond their ends.
    """
    index = np.clip(np.searchsorted(edges, place) - 1, 0, len(tables) - 1)
    z = (2.0 * place - edges[index] - edges[index + 1]) / (edges[index + 1] - edges[index])
    both = np.asarray(chebyshev.chebval(z, np.moveaxis(tables[index], 0, -1), tensor=False), dtype=float)
    return both[0], both[1]
