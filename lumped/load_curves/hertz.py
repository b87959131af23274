"""Hertz 1882: the parabola r^2/(2R)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lumped.load_curves.base import GAUSS_POINTS, LoadCurve
from lumped.load_curves.half_space import HalfSpaceCurve
from lumped.numbers import Real, falling_zero, gauss


@dataclass(frozen=True)
class Hertz(HalfSpaceCurve):
    """F = (4/3) E* sqrt(R) depth^(3/2), a = sqrt(R depth)."""

    radius: float
    closed: ClassVar[bool] = True

    def force(self, depth: ArrayLike) -> Real:
        """F/E*, m^2."""
        return 4.0 / 3.0 * self.radius**0.5 * np.maximum(depth, 0.0) ** 1.5

    def contact_radius(self, depth: ArrayLike) -> Real:
        """a, m."""
        if isinstance(depth, float):
            return (self.radius * max(depth, 0.0)) ** 0.5
        return np.sqrt(self.radius * np.maximum(depth, 0.0))

    def depth(self, contact_radius: ArrayLike) -> Real:
        """a^2/R, m."""
        return np.asarray(contact_radius) ** 2 / self.radius

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """2a/R."""
        return 2.0 * np.asarray(contact_radius) / self.radius


@dataclass(frozen=True)
class HertzImpact:
    """Scales of the elastic impact of a parabola: s, m, N, m."""

    duration: float
    depth: float
    force: float
    contact_radius: float


def hertz_impact(radius: float, modulus: float, mass: float, velocity: float) -> HertzImpact:
    """Hertz impact on an elastic half-space of contact modulus E* (Pa): duration 2.868266 (m^2/(R E*^2
    v))^(1/5).

    The products are ordered so that no accepted scene leaves double precision.
    """
    inertia = mass / modulus
    depth = (15.0 / 16.0 * inertia * velocity**2 / radius**0.5) ** 0.4
    duration = 2.868265642 * (inertia**2 / (radius * velocity)) ** 0.2
    force = 4.0 / 3.0 * modulus * (radius * depth) ** 0.5 * depth
    return HertzImpact(duration, depth, force, (radius * depth) ** 0.5)


def power_impact(curve: LoadCurve, alpha: float, modulus: float, mass: float, velocity: float) -> HertzImpact:
    """Scales of the elastic impact on a curve F = E* D depth^alpha, modulus in Pa.

    It lasts 2 (d_m/v) int_0^1 dx/sqrt(1 - x^(alpha + 1)), d_m the depth at which nothing moves.
    """
    factor, power = float(curve.force(1.0)), alpha + 1.0
    depth = math.pow(0.5 * power * (mass / modulus / factor) * velocity**2, 1.0 / power)
    integral = math.sqrt(math.pi) * math.gamma(1.0 + 1.0 / power) / math.gamma(0.5 + 1.0 / power)
    force = modulus * factor * math.pow(depth, alpha)
    return HertzImpact(2.0 * depth / velocity * integral, depth, force, float(curve.contact_radius(depth)))


def curve_impact(curve: LoadCurve, modulus: float, mass: float, velocity: float) -> HertzImpact:
    """Scales of the elastic impact on any curve that has an energy, modulus in Pa.

    It turns where E* W(d_m) = m v^2/2 and lasts 2/v int_0^d_m dd/sqrt(1 - W(d)/W(d_m)), the root taken out by
    d = d_m (1 - s^2).
    """
    wanted = 0.5 * mass / modulus * velocity**2
    deepest = 1e-9  # m, and doubled until it is too deep
    while float(curve.energy(deepest)) < wanted:
        deepest *= 2.0
    depth = falling_zero(lambda d: 1.0 - float(curve.energy(d)) / wanted, 0.0, deepest)
    nodes, weights = gauss(GAUSS_POINTS)
    left = 1.0 - curve.energy(depth * (1.0 - nodes**2)) / wanted
    duration = 4.0 * depth / velocity * float(weights @ (nodes / np.sqrt(left)))
    force = modulus * float(curve.force(depth))
    return HertzImpact(duration, depth, force, float(curve.contact_radius(depth)))
