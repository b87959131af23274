"""Outlines of what is round, over the distance r from the lowest point: the circle, and the parabola at its tip.

`radius` R and r in m, r a scalar or an array.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def circle(r: ArrayLike, radius: float) -> NDArray[np.float64]:
    """R - sqrt(R^2-r^2) = r^2/(R + sqrt(R^2-r^2)), m, which cancels no digit; infinite beyond R."""
    square = (np.asarray(r, dtype=float) / radius) ** 2
    rise = radius * square / (1.0 + np.sqrt(np.maximum(1.0 - square, 0.0)))
    return np.where(square <= 1.0, rise, np.inf)


def circle_slope(r: ArrayLike, radius: float) -> NDArray[np.float64]:
    """r/sqrt(R^2-r^2), infinite from R on."""
    ratio = np.abs(np.asarray(r, dtype=float)) / radius
    with np.errstate(divide="ignore"):
        return np.where(ratio < 1.0, ratio / np.sqrt(np.maximum(1.0 - ratio**2, 0.0)), np.inf)


def parabola(r: ArrayLike, radius: float) -> NDArray[np.float64]:
    """r^2/(2R), m."""
    return np.asarray(np.asarray(r, dtype=float) ** 2 / (2.0 * radius))


def parabola_slope(r: ArrayLike, radius: float) -> NDArray[np.float64]:
    """r/R."""
    return np.asarray(np.abs(np.asarray(r, dtype=float)) / radius)
