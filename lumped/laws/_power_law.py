"""A spring k depth^alpha and a damper beside it: what most pounding laws are."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar

from lumped.laws._force_law import ForceLaw
from lumped.numbers import Real
from lumped.solvers.point.bodies import Bodies, Stage

GRADINGS = (1, 2, 4)  # powers of the steps' grading that are tried, the first which makes exponents whole is taken


@dataclass(frozen=True, kw_only=True)
class PowerLaw(ForceLaw):
    """F = k depth^alpha + damper(depth, rate); k in N/m^alpha."""

    k: float
    alpha: float

    def exponents(self, stage: Stage) -> tuple[float, ...]:
        """The powers of the depth in the force."""
        return (self.alpha,)

    def grading(self, stage: Stage) -> int:
        """What makes whole numbers of the exponents; at least their fractions small beside it."""
        powers = self.exponents(stage)
        return next((p for p in GRADINGS if all((p * n).is_integer() for n in powers)), GRADINGS[-1])

    @abstractmethod
    def damper(self, depth: Real, rate: Real, stage: Stage) -> Real:
        """The damper's force, N."""

    @abstractmethod
    def damper_tangents(self, depth: Real, rate: Real, stage: Stage) -> tuple[Real, Real]:
        """The slopes of the damper's force over depth, N/m, and rate, N s/m."""

    def force(self, depth: Real, rate: Real, stage: Stage) -> Real:
        """F, N."""
        return self.k * depth**self.alpha + self.damper(depth, rate, stage)

    def tangents(self, depth: Real, rate: Real, stage: Stage) -> tuple[Real, Real]:
        """dF/d depth, dF/d rate."""
        over_depth, over_rate = self.damper_tangents(depth, rate, stage)
        return self.k * self.alpha * depth ** (self.alpha - 1.0) + over_depth, over_rate

    def lost(self, depth: Real, rate: Real, stage: Stage) -> Real:
        """The damper's force, N."""
        return self.damper(depth, rate, stage)

    def stored(self, depth: float, stage: Stage) -> float:
        """k depth^(alpha + 1)/(alpha + 1), J."""
        return float(self.k * depth ** (self.alpha + 1.0) / (self.alpha + 1.0))

    def time_scale(self, bodies: Bodies) -> float:
        """Contact time of the spring alone."""
        return spring_contact_time(self.k, self.alpha, bodies)


@dataclass(frozen=True, kw_only=True)
class Undamped(PowerLaw):
    """The spring alone: nothing is lost."""

    def damper(self, depth: Real, rate: Real, stage: Stage) -> Real:
        """None."""
        return 0.0 * depth

    def damper_tangents(self, depth: Real, rate: Real, stage: Stage) -> tuple[Real, Real]:
        """None."""
        return 0.0, 0.0 * depth


def spring_depth(k: float, alpha: float, bodies: Bodies) -> float:
    """The greatest depth of the impact on k depth^alpha, m."""
    power = alpha + 1.0
    return math.pow(0.5 * power * bodies.mass / k * bodies.velocity**2, 1.0 / power)


def spring_contact_time(k: float, alpha: float, bodies: Bodies) -> float:
    """2 (d_m/v) int_0^1 dx/sqrt(1 - x^(alpha + 1)), s, of the impact on k depth^alpha."""
    power = alpha + 1.0
    integral = math.sqrt(math.pi) * math.gamma(1.0 + 1.0 / power) / math.gamma(0.5 + 1.0 / power)
    return 2.0 * spring_depth(k, alpha, bodies) / bodies.velocity * integral


def spring_of_peak(force: float, alpha: float, bodies: Bodies) -> float:
    """k, N/m^alpha, of the spring whose elastic impact peaks at `force`, N."""
    energy = 0.5 * (alpha + 1.0) * bodies.mass * bodies.velocity**2
    return float(force * (force / energy) ** alpha)


@dataclass(frozen=True, kw_only=True)
class SpringDamped(PowerLaw):
    """The force is zero at depth zero and never jumps. Both exits are one, but where something else than the law drives
    the bodies apart: faster than 1/factor it pulls.

    Its restitution depends on factor times the velocity at touch alone, whatever the exponent.
    """

    alpha: float = 1.5

    @abstractmethod
    def factor(self, stage: Stage) -> float:
        """The damper's force over the spring's and the rate, s/m."""

    def letting_go(self, stage: Stage) -> float:
        """-1/factor, m/s."""
        factor = self.factor(stage)
        return -1.0 / factor if factor else -math.inf

    def damper(self, depth: Real, rate: Real, stage: Stage) -> Real:
        """k depth^alpha factor rate."""
        return self.k * self.factor(stage) * depth**self.alpha * rate

    def damper_tangents(self, depth: Real, rate: Real, stage: Stage) -> tuple[Real, Real]:
        """Its slopes."""
        strength = self.k * self.factor(stage)
        return strength * self.alpha * depth ** (self.alpha - 1.0) * rate, strength * depth**self.alpha


@dataclass(frozen=True, kw_only=True)
class OscillatorDamped(PowerLaw):
    """F = k depth^alpha + c depth^((alpha - 1)/2) rate; k in N/m^alpha, c in N s/m^((alpha + 1)/2).

    In x = depth^((alpha + 1)/2) 2/(alpha + 1) spring and damper are linear, whatever the exponent: the impact is that
    of an oscillator with the damping ratio c/sqrt(2 (alpha + 1) m k).
    `rebounds`: whether the damper acts in the rebound too.
    """

    c: float
    alpha: float = 1.5
    rebounds: ClassVar[bool]

    @property
    def tensile(self) -> bool:
        """By a damper that acts in the rebound."""
        return self.rebounds and self.c > 0.0

    def exponents(self, stage: Stage) -> tuple[float, ...]:
        """The spring's and the damper's."""
        return (self.alpha, 0.5 * (self.alpha - 1.0)) if self._damped(stage) else (self.alpha,)

    def damper(self, depth: Real, rate: Real, stage: Stage) -> Real:
        """c depth^((alpha - 1)/2) rate, where it acts."""
        if not self._damped(stage):
            return 0.0 * depth
        return self.c * depth ** (0.5 * (self.alpha - 1.0)) * rate

    def damper_tangents(self, depth: Real, rate: Real, stage: Stage) -> tuple[Real, Real]:
        """Its slopes."""
        if not self._damped(stage):
            return 0.0, 0.0 * depth
        power = 0.5 * (self.alpha - 1.0)
        return self.c * power * depth ** (power - 1.0) * rate, self.c * depth**power

    def _damped(self, stage: Stage) -> bool:
        return self.rebounds or stage.approaching
