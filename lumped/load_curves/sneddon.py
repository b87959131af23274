"""The half-space under cone, power, sphere and a cone that ends in a sphere: Sneddon's integrals in closed form.

Sneddon 1965, doi 10.1016/0020-7225(65)90019-4.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import atanh, cos, gamma, inf, pi, radians, sin, sqrt, tan, tanh
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import BadInput, Fault
from lumped.load_curves.base import GAUSS_POINTS
from lumped.load_curves.half_space import HalfSpaceCurve, KnownByRadius
from lumped.numbers import Array, Real, gauss

# u^2 - r in POWERS of r = u tanh u: below SHALLOW what follows is less than rounding.
SERIES = np.array(
    [1 / 3, 4 / 45, 16 / 945, 16 / 14175, -64 / 93555, -69248 / 212837625, -512 / 8292375, 211712 / 32564156625]
)
POWERS = np.arange(2.0, 10.0)
SHALLOW = 0.05  # rounding: of r, the depth over the radius; above it u - tanh u keeps its digits as a difference
TINY = 1e-300  # in place of zero, in a quotient


@dataclass(frozen=True)
class ConeCurve(HalfSpaceCurve):
    """depth = (pi/2) a tan(theta), F = (2/pi) E* depth^2/tan(theta) (Sneddon 1948).

    `angle` theta lies between the face and the undeformed surface, degrees, above 0 and below 90; raises BadInput.
    Doi 10.1016/0020-7225(65)90019-4.
    """

    angle: float
    closed: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if not 0.0 < self.angle < 90.0:
            message = f"must lie between 0 and 90 degrees, is {self.angle}: at 0 use a punch, at 90 there is no face"
            raise BadInput(Fault("cone", "angle", message))

    @property
    def steepness(self) -> float:
        """tan(theta)."""
        return tan(radians(self.angle))

    def force(self, depth: ArrayLike) -> Real:
        """F/E*, m^2."""
        return 2.0 / (pi * self.steepness) * np.maximum(depth, 0.0) ** 2

    def contact_radius(self, depth: ArrayLike) -> Real:
        """2 depth/(pi tan(theta)), m."""
        return 2.0 / (pi * self.steepness) * np.maximum(depth, 0.0)

    def depth(self, contact_radius: ArrayLike) -> Real:
        """(pi/2) a tan(theta), m."""
        return 0.5 * pi * self.steepness * np.asarray(contact_radius)

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """(pi/2) tan(theta)."""
        return np.full_like(np.asarray(contact_radius, dtype=float), 0.5 * pi * self.steepness)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> Array:
        """p/E* = (tan(theta)/2) arcosh(a/r), infinite at the tip."""
        r = np.abs(np.asarray(radius, dtype=float))
        with np.errstate(divide="ignore"):
            ratio = np.divide(contact_radius, r, out=np.ones_like(r), where=r < contact_radius)
        return np.asarray(0.5 * self.steepness * np.arccosh(ratio))


@dataclass(frozen=True)
class Power(HalfSpaceCurve):
    """depth = beta c a^n with beta = sqrt(pi) Gamma(n/2+1)/Gamma((n+1)/2), F = 2n/(n+1) E* a depth: alpha = 1 + 1/n.

    Any power of the distance from the axis, c r^n (Galin 1946).
    `coefficient` c in m^(1-n), above 0; `exponent` n >= 1 (below that the profile is not convex). Raises BadInput.
    Doi 10.1016/0020-7225(65)90019-4.
    """

    coefficient: float
    exponent: float
    closed: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if not 0.0 < self.coefficient < inf:
            raise BadInput(Fault("power", "coefficient", f"must be above 0 m^(1-n), is {self.coefficient}"))
        if not 1.0 <= self.exponent <= 100.0:
            raise BadInput(Fault("power", "exponent", f"must lie in [1, 100], is {self.exponent}"))

    @property
    def _steepness(self) -> float:
        """beta c."""
        n = self.exponent
        return self.coefficient * sqrt(pi) * gamma(0.5 * n + 1.0) / gamma(0.5 * n + 0.5)

    def force(self, depth: ArrayLike) -> Real:
        """F/E*, m^2."""
        n = self.exponent
        return 2.0 * n / (n + 1.0) * np.maximum(depth, 0.0) * self.contact_radius(depth)

    def contact_radius(self, depth: ArrayLike) -> Real:
        """(depth/(beta c))^(1/n), m."""
        return (np.maximum(depth, 0.0) / self._steepness) ** (1.0 / self.exponent)

    def depth(self, contact_radius: ArrayLike) -> Real:
        """beta c a^n, m."""
        return self._steepness * np.asarray(contact_radius) ** self.exponent

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """n beta c a^(n-1)."""
        return self.exponent * self._steepness * np.asarray(contact_radius) ** (self.exponent - 1.0)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> Array:
        """p/E* = (n beta c/pi) a^(n-1) w 2F1(1, 1-n/2; 3/2; w^2) with w^2 = 1 - r^2/a^2; infinite at a cone's tip."""
        from scipy.special import hyp2f1

        r = np.abs(np.asarray(radius, dtype=float))
        square = 1.0 - np.divide(r, contact_radius, out=np.ones_like(r), where=r < contact_radius) ** 2
        series = hyp2f1(1.0, 1.0 - 0.5 * self.exponent, 1.5, square)
        return np.asarray(self.depth_slope(contact_radius) / pi * np.sqrt(square) * series)


@dataclass(frozen=True)
class SneddonSphere(HalfSpaceCurve):
    """F = E* [(R^2 + a^2) u - a R], depth = a u, with u = artanh(a/R): a stays below R at every depth."""

    radius: float
    closed: ClassVar[bool] = True

    @property
    def extent(self) -> float:
        """R, m."""
        return self.radius

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


@dataclass(frozen=True)
class SphereConeCurve(KnownByRadius):
    """A sphere of this radius R, m, up to b = R sin(theta), from there on a face at the `angle` theta, degrees.

    The face is tangent to it: Briscoe, Sebastian and Adams 1994, doi 10.1088/0022-3727/27/6/013.
    """

    radius: float
    angle: float

    @property
    def tip(self) -> float:
        """Radius b of the circle where sphere and cone meet, m."""
        return self.radius * sin(radians(self.angle))

    def depth(self, contact_radius: ArrayLike) -> Real:
        """a [L + tan(theta) arccos(b/a)], L = ln((R + a)/(R cos(theta) + sqrt(a^2 - b^2))); up to b the sphere's, m."""
        a = np.asarray(contact_radius, dtype=float)
        beyond = np.maximum(a, self.tip)
        cone = beyond * (self._sphere(beyond) + self.steepness * self._turn(beyond))
        return np.where(a > self.tip, cone, self._tip.depth(np.minimum(a, self.tip)))

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """L + tan(theta) arccos(b/a) + a/(R + a) + (b^2 - c w)/(c (c + w)), c = R cos(theta), w = sqrt(a^2 - b^2)."""
        a = np.asarray(contact_radius, dtype=float)
        beyond, c = np.maximum(a, self.tip), self._height
        w = self._reach(beyond)
        rest = beyond / (self.radius + beyond) + (self.tip**2 - c * w) / (c * (c + w))
        cone = self._sphere(beyond) + self.steepness * self._turn(beyond) + rest
        return np.where(a > self.tip, cone, self._tip.depth_slope(np.minimum(a, self.tip)))

    def force_at(self, contact_radius: ArrayLike) -> Real:
        """F/E* = (R^2 + a^2) L - R a + c w + tan(theta) (a^2 arccos(b/a) + b w), m^2; up to b the sphere's."""
        a = np.asarray(contact_radius, dtype=float)
        beyond = np.maximum(a, self.tip)
        w = self._reach(beyond)
        sphere = (self.radius**2 + beyond**2) * self._sphere(beyond) - self.radius * beyond + self._height * w
        cone = self.steepness * (beyond**2 * self._turn(beyond) + self.tip * w)
        return np.where(a > self.tip, sphere + cone, self._tip.force_at(np.minimum(a, self.tip)))

    def pressure(self, radius: ArrayLike, contact_radius: float) -> Array:
        """p/E* = (1/pi) int_r^a depth'(x)/sqrt(x^2-r^2) dx, up to the tip's circle and from there on."""
        r = np.minimum(np.abs(np.asarray(radius, dtype=float)), contact_radius)
        ends = np.clip(np.array((0.0, self.tip, np.inf)), r[..., None], contact_radius)
        s = np.sqrt((ends - r[..., None]) * (ends + r[..., None]))  # distance along the surface's chord, m
        nodes, weights = gauss(GAUSS_POINTS)
        width = np.diff(s, axis=-1)
        along = s[..., :-1, None] + width[..., None] * nodes**2
        x = np.hypot(along, r[..., None, None])
        slope_over_x = np.divide(self.depth_slope(x), x, out=np.zeros_like(x), where=x > 0.0)
        return np.asarray((width * (slope_over_x @ (2.0 * nodes * weights))).sum(axis=-1) / np.pi)

    @property
    def breaks(self) -> tuple[float, ...]:
        """b, m."""
        return (self.tip,)

    @property
    def _tip(self) -> SneddonSphere:
        return SneddonSphere(self.radius)

    @property
    def steepness(self) -> float:
        """tan(theta)."""
        return tan(radians(self.angle))

    @property
    def _height(self) -> float:
        """c = R cos(theta), m."""
        return self.radius * cos(radians(self.angle))

    def _reach(self, a: Array) -> Array:
        """w, m."""
        return np.sqrt((a - self.tip) * (a + self.tip))

    def _turn(self, a: Array) -> Array:
        """arccos(b/a)."""
        return np.arctan2(self._reach(a), self.tip)

    def _sphere(self, a: Array) -> Array:
        """L."""
        return np.log((self.radius + a) / (self._height + self._reach(a)))
