"""Local polynomial interpolation between the rows of a smooth curve, numpy only."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
POINTS = 4
FITTED, DEGREE = 13, 4
EQUAL = 1e-12  # of all the rows: two as close as that are one, and no slope lies between them but rounding's


def local(x: Array, y: Array, at: Array, points: int = POINTS) -> Array:
    """The polynomials through the `points` nodes around each place of `at`, shape (m,): shape (..., m).

    `x`, shape (n,), ascends strictly; `y` has the shape (..., n). With fewer nodes than `points` all of them
    count.
    """
    points = min(points, x.size)
    first = np.searchsorted(x, at) - (points + 1) // 2
    stencil = np.clip(first, 0, x.size - points) + np.arange(points)[:, None]
    nodes = x[stencil]
    away, weights = at - nodes, np.ones_like(nodes)
    for j in range(points):
        for i in range(points):
            if i != j:
                weights[j] *= away[i] / (nodes[j] - nodes[i])
    return np.asarray((weights * y[..., stencil]).sum(axis=-2))


def peak(x: Array, y: Array) -> tuple[float, float]:
    """Place and height of the highest point of a smooth curve given by rows, x ascending; of equal x the highest."""
    new = np.flatnonzero(np.diff(x, prepend=-np.inf) > EQUAL * (x[-1] - x[0]))
    rows, values = x[new], np.maximum.reduceat(y, new)
    return highest(lambda at: local(rows, values, at), rows)


def highest(curve: Callable[[Array], Array], places: Array) -> tuple[float, float]:
    """Place and height of the highest point of a curve that can be evaluated anywhere, shape (n,) -> (n,).

    The polynomial of fourth degree fitted around the highest of `places` (ascending, at least two) has it:
    what noise the curve has there averages out.
    """
    values = curve(places)
    i = int(np.argmax(values))
    low, high = places[max(i - 1, 0)], places[min(i + 1, places.size - 1)]
    around = np.linspace(-1.0, 1.0, FITTED)
    between = np.clip(0.5 * (low + high) + 0.5 * (high - low) * around, low, high)  # the curve may jump where it begins
    fit = np.polynomial.Polynomial.fit(around, curve(between), DEGREE)
    flat = fit.deriv().roots()
    inside = np.real(flat[(np.abs(np.imag(flat)) < 1e-12) & (np.abs(np.real(flat)) < 1.0)])
    candidates = np.concatenate([inside, [-1.0, 1.0]])
    heights = fit(candidates)
    best = int(np.argmax(heights))
    return float(0.5 * (low + high) + 0.5 * (high - low) * candidates[best]), float(heights[best])
