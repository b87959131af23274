"""Sneddon 1965: the true sphere, doi 10.1016/0020-7225(65)90019-4."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import atanh, tanh
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lumped.load_curves.half_space import HalfSpaceCurve
from lumped.numbers import Array, Real

# u^2 - r in POWERS of r = u tanh u: below SHALLOW what follows is less than rounding.
SERIES = np.array(
    [1 / 3, 4 / 45, 16 / 945, 16 / 14175, -64 / 93555, -69248 / 212837625, -512 / 8292375, 211712 / 32564156625]
)
POWERS = np.arange(2.0, 10.0)
SHALLOW = 0.05  # rounding: of r, the depth over the radius; above it u - tanh u keeps its digits as a difference
TINY = 1e-300  # in place of zero, in a quotient


@dataclass(frozen=True)
class SneddonSphere(HalfSpaceCurve):
    """F = E* [(R^2 + a^2) u - a R], depth = a u, with u = artanh(a/R): a stays below R at every depth."""

    radius: float
    closed: ClassVar[bool] = True

    @property
    def extent(self) -> float:
        """R, m."""
        return self.radius

    def force(self, depth: ArrayLike) -> Real:
        """F/E*, m^2."""
        return self.force_and_slope(depth)[0]

    def force_and_slope(self, depth: ArrayLike) -> tuple[Real, Real]:
        """F/E*, m^2, and 2 a, m."""
        ratio = self._ratio(depth)
        t, rest = _tanh_and_rest(ratio)
        return self.radius**2 * (rest + ratio * t), 2.0 * self.radius * t

    def contact_radius(self, depth: ArrayLike) -> Real:
        """a = R tanh u with u tanh u = depth/R, m."""
        if isinstance(depth, float):
            return self.radius * tanh(_angle(max(depth, 0.0) / self.radius, tanh))
        return self.radius * _tanh_and_rest(self._ratio(depth))[0]

    def depth(self, contact_radius: ArrayLike) -> Real:
        """a artanh(a/R), m; infinite at a = R, nan beyond."""
        if isinstance(contact_radius, float) and abs(contact_radius) < self.radius:
            return contact_radius * atanh(contact_radius / self.radius)
        a = np.asarray(contact_radius)
        with np.errstate(divide="ignore", invalid="ignore"):
            return a * np.arctanh(a / self.radius)

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """artanh(a/R) + a R/(R^2 - a^2)."""
        ratio = np.asarray(contact_radius) / self.radius
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.arctanh(ratio) + ratio / ((1.0 - ratio) * (1.0 + ratio))

    def _ratio(self, depth: ArrayLike) -> Array:
        """Depths over R, an array of their shape."""
        return np.asarray(np.maximum(depth, 0.0) / self.radius)


def _tanh_and_rest(ratio: Array) -> tuple[Array, Array]:
    """tanh u and u - tanh u with u tanh u = ratio >= 0, both to full relative precision."""
    if not np.maximum.reduce(ratio, axis=None, initial=0.0) >= SHALLOW:  # sooner told than by the array's own method
        return _shallow(ratio)
    deep = ratio >= SHALLOW
    near, rest = _shallow(np.where(deep, 0.0, ratio))
    u = _angle(np.where(deep, ratio, SHALLOW), np.tanh)
    t = np.tanh(u)
    return np.where(deep, t, near), np.where(deep, u - t, rest)


def _shallow(ratio: Array) -> tuple[Array, Array]:
    """The same below SHALLOW."""
    more = np.power.outer(ratio, POWERS) @ SERIES
    u = (ratio + more) ** 0.5 + TINY
    return ratio / u, more / u


def _angle(ratio: Real, tanh: Callable[[Real], Real]) -> Real:
    """u >= 0 with u tanh u = ratio, by Newton; `tanh` is the scalar's or the array's.

    The first guess errs by 5 % at most, three steps make that 5e-14 and the fourth leaves rounding.
    """
    u = (ratio + ratio * ratio / 3.0) ** 0.5 + TINY
    for _ in range(4):
        t = tanh(u)
        u = u - (u * t - ratio) / (t + u * (1.0 - t * t))
    return u
