"""The half-space under a cone that ends in a sphere, the face tangent to it (Briscoe, Sebastian and Adams 1994,
doi 10.1088/0022-3727/27/6/013): Sneddon's integrals of both parts in closed form.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, radians, sin, tan

import numpy as np
from numpy.typing import ArrayLike

from lumped.load_curves.base import GAUSS_POINTS
from lumped.load_curves.half_space import KnownByRadius
from lumped.load_curves.sneddon_sphere import SneddonSphere
from lumped.numbers import Array, Real, gauss


@dataclass(frozen=True)
class SphereConeCurve(KnownByRadius):
    """A sphere of this radius R, m, up to b = R sin(theta), from there on a face at the `angle` theta, degrees."""

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
