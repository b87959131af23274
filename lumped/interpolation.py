"""Local polynomial interpolation between the rows of a smooth curve, numpy only."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
POINTS = 4
FINE = 65


def local(x: Array, y: Array, at: Array, points: int = POINTS) -> Array:
    """The polynomial through the `points` nodes around each place of `at`; x ascends strictly, shapes (n,), (n,), (m,).

    With fewer nodes than `points` the polynomial runs through all of them.
    """
    points = min(points, x.size)
    first = np.searchsorted(x, at) - (points + 1) // 2
    stencil = np.clip(first, 0, x.size - points)[:, None] + np.arange(points)
    nodes = x[stencil]
    weights = np.ones_like(nodes)
    for j in range(points):
        for i in range(points):
            if i != j:
                weights[:, j] *= (at - nodes[:, i]) / (nodes[:, j] - nodes[:, i])
    return np.asarray((weights * y[stencil]).sum(axis=1))


def peak(x: Array, y: Array, points: int = POINTS) -> tuple[float, float]:
    """Place and height of the highest point of a smooth curve, between its rows."""
    i = int(np.argmax(y))
    low, high = max(i - 1, 0), min(i + 1, x.size - 1)
    fine = np.linspace(x[low], x[high], FINE)
    values = local(x, y, fine, points)
    k = int(np.argmax(values))
    if k in (0, FINE - 1):
        return float(fine[k]), float(values[k])
    return vertex(fine[k - 1 : k + 2], values[k - 1 : k + 2])


def vertex(x: Array, y: Array) -> tuple[float, float]:
    """Place and height of the top of the parabola through three points, the middle one the highest."""
    left, right = x[0] - x[1], x[2] - x[1]
    low, high = (y[0] - y[1]) / left, (y[2] - y[1]) / right
    bend = (high - low) / (right - left)
    if bend >= 0.0:
        return float(x[1]), float(y[1])
    slope = low - bend * left
    shift = min(max(-0.5 * slope / bend, left), right)
    return float(x[1] + shift), float(y[1] + slope * shift + bend * shift**2)
