"""A damper that makes the impact a linear oscillator: F = k depth^alpha + c depth^((alpha - 1)/2) rate.

With x = depth^((alpha + 1)/2) 2/(alpha + 1) spring and damper are linear, whatever the exponent; the damping ratio
is c/sqrt(2 (alpha + 1) m k).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Self

from lumped.laws._parameters import Parameters
from lumped.laws._power_law import PowerLaw
from lumped.numbers import Real
from lumped.scene.scene import Scene
from lumped.solvers.point.bodies import Stage

# The exponent for which the dampings of a given restitution are told.
TOLD_FOR = 1.5


@dataclass(frozen=True, kw_only=True)
class OscillatorDamped(PowerLaw):
    """k in N/m^alpha, c in N s/m^((alpha + 1)/2); `rebounds`: whether the damper acts in the rebound too."""

    c: float
    alpha: float = 1.5
    rebounds: ClassVar[bool]

    @classmethod
    def damped_by(cls, scene: Scene, key: str, unit: float = 1.0) -> Self:
        """The law for a scene with c = unit times the damping called `key` times sqrt(m k). Raises BadInput."""
        given = Parameters(scene, cls.name)
        alpha = given.exponent()
        k = given.stiffness(alpha)
        kind, damping = given.damping((key,))
        if kind == "e":
            damping = _at_exponent(given.meeting(cls.name, damping), alpha)
        return cls(k=k, c=unit * damping * math.sqrt(scene.reduced_mass * k), alpha=alpha, **given.common())

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


def _at_exponent(damping: float, alpha: float) -> float:
    """The damping with the ratio, and so the restitution, that `damping` gives at alpha = 3/2."""
    return damping * math.sqrt((alpha + 1.0) / (TOLD_FOR + 1.0))
