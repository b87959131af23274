"""A damper as strong as the spring: F = k depth^alpha (1 + factor rate)."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any

from lumped.laws._power_law import PowerLaw
from lumped.solvers.point.bodies import Stage


@dataclass(frozen=True, kw_only=True)
class SpringDamped(PowerLaw):
    """The force is zero at depth zero and nowhere else, so that both exits are one, and it never jumps.

    Its restitution depends on factor times the velocity at touch alone, whatever the exponent.
    """

    alpha: float = 1.5

    @abstractmethod
    def factor(self, stage: Stage) -> float:
        """The damper's force over the spring's and the rate, s/m."""

    def damper(self, depth: Any, rate: Any, stage: Stage) -> Any:
        """k depth^alpha factor rate."""
        return self.k * self.factor(stage) * depth**self.alpha * rate

    def damper_tangents(self, depth: Any, rate: Any, stage: Stage) -> tuple[Any, Any]:
        """Its slopes."""
        strength = self.k * self.factor(stage)
        return strength * self.alpha * depth ** (self.alpha - 1.0) * rate, strength * depth**self.alpha
