"""Sneddon 1965: the true sphere, doi 10.1016/0020-7225(65)90019-4."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lumped.load_curves.half_space import HalfSpaceCurve
from lumped.numbers import Array, Real

# u - tanh u = u^3/3 - 2u^5/15 + ...: where the difference itself would lose digits.
SERIES = (1 / 3, -2 / 15, 17 / 315, -62 / 2835, 1382 / 155925, -21844 / 6081075, 929569 / 638512875)
SERIES_BELOW = 0.15  # rounding: of u, below it the difference would lose digits and the series stands
# Depth over radius.
SHALLOW = 0.05


@dataclass(frozen=True)
class SneddonSphere(HalfSpaceCurve):
    """F = E* [(R^2 + a^2) u - a R], depth = a u, with u = artanh(a/R): a stays below R at every depth."""

    radius: float

    @property
    def extent(self) -> float:
        """R, m."""
        return self.radius

    def force(self, depth: ArrayLike) -> Real:
        """F/E*, m^2."""
        return self.force_and_slope(depth)[0]

    def force_and_slope(self, depth: ArrayLike) -> tuple[Real, Real]:
        """F/E*, m^2, and 2 a, m."""
        u = self._angles(depth)
        t = np.tanh(u)
        return self.radius**2 * (_minus_tanh(u, t) + t * t * u), 2.0 * self.radius * t

    def contact_radius(self, depth: ArrayLike) -> Real:
        """a = R tanh u with u tanh u = depth/R, m."""
        if isinstance(depth, float):
            ratio = max(depth, 0.0) / self.radius
            return self.radius * math.tanh(_angle(ratio, math.tanh, ratio))
        return self.radius * np.tanh(self._angles(depth))

    def depth(self, contact_radius: ArrayLike) -> Real:
        """a artanh(a/R), m; infinite at a = R, nan beyond."""
        if isinstance(contact_radius, float) and abs(contact_radius) < self.radius:
            return contact_radius * math.atanh(contact_radius / self.radius)
        a = np.asarray(contact_radius)
        with np.errstate(divide="ignore", invalid="ignore"):
            return a * np.arctanh(a / self.radius)

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """artanh(a/R) + a R/(R^2 - a^2)."""
        ratio = np.asarray(contact_radius) / self.radius
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.arctanh(ratio) + ratio / ((1.0 - ratio) * (1.0 + ratio))

    def _angles(self, depth: ArrayLike) -> Array:
        """u at depths, an array of their shape."""
        ratio = np.asarray(np.maximum(depth, 0.0) / self.radius)
        return np.asarray(_angle(ratio, np.tanh, _largest(ratio)))


def _angle(ratio: Real, tanh: Callable[[Real], Real], deepest: float) -> Real:
    """u >= 0 with u tanh u = ratio, by Newton; `tanh` is the scalar's or the array's.

    The first guess errs by 5 % at most, three steps make that 5e-14 and the fourth leaves rounding; shallow it errs by
    2/45 ratio^2, and two steps do.
    """
    u = (ratio + ratio * ratio / 3.0) ** 0.5 + 1e-300
    for _ in range(2 if deepest < SHALLOW else 4):
        t = tanh(u)
        u = u - (u * t - ratio) / (t + u * (1.0 - t * t))
    return u


def _minus_tanh(u: Array, t: Array) -> Array:
    """u - tanh u to full relative precision."""
    square = u * u
    series = SERIES[-1] * square + SERIES[-2]
    for coefficient in SERIES[-3::-1]:
        series *= square
        series += coefficient
    series = u * square * series
    return series if _largest(u) < SERIES_BELOW else np.where(u < SERIES_BELOW, series, u - t)


def _largest(values: Array) -> float:
    """Of values >= 0 of any shape; sooner told than by their own method."""
    return float(np.maximum.reduce(values, axis=None, initial=0.0))
