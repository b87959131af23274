"""Jankowski's nonlinear viscoelastic model, "(8)" to "(10)": damped while approaching, elastic in the rebound.

F = k depth^alpha + 2 xi sqrt(m k depth^(alpha - 1)) rate, the damper in the approach only; alpha = 3/2 in the
paper. Doi 10.1002/eqe.434.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from lumped.collide.bodies import Stage
from lumped.keys import Key
from lumped.laws._parameters import (
    COMMON,
    EXPONENT_FROM_ONE,
    RESTITUTION,
    STIFFNESS,
    Parameters,
    damping_keys,
    formula_key,
)
from lumped.laws._power_law import PowerLaw
from lumped.scene import Scene

KEYS: Mapping[str, Key] = {
    **STIFFNESS,
    **EXPONENT_FROM_ONE,
    **RESTITUTION,
    **damping_keys("xi"),
    **formula_key("jankowski"),
    **COMMON,
}


@dataclass(frozen=True, kw_only=True)
class Jankowski(PowerLaw):
    """The law with k, N/m^alpha, and the damper's c = 2 xi sqrt(m k), N s/m^((alpha + 1)/2)."""

    c: float
    alpha: float = 1.5
    name: ClassVar[str] = "jankowski"

    def exponents(self, stage: Stage) -> tuple[float, ...]:
        """The spring's and the damper's."""
        return (self.alpha, 0.5 * (self.alpha - 1.0)) if stage.approaching else (self.alpha,)

    def damper(self, depth: Any, rate: Any, stage: Stage) -> Any:
        """c depth^((alpha - 1)/2) rate in the approach."""
        if not stage.approaching:
            return 0.0 * depth
        return self.c * depth ** (0.5 * (self.alpha - 1.0)) * rate

    def damper_tangents(self, depth: Any, rate: Any, stage: Stage) -> tuple[Any, Any]:
        """Its slopes."""
        if not stage.approaching:
            return 0.0, 0.0 * depth
        power = 0.5 * (self.alpha - 1.0)
        return self.c * power * depth ** (power - 1.0) * rate, self.c * depth**power


def of(scene: Scene) -> Jankowski:
    """The law for a scene. Raises BadInput.

    With x = depth^((alpha + 1)/2) 2/(alpha + 1) the approach is a linear oscillator of the damping ratio
    xi sqrt(2/(alpha + 1)), whatever the exponent: xi grows with sqrt((alpha + 1)/2) at the same e.
    """
    given = Parameters(scene, Jankowski.name)
    alpha = given.exponent()
    k = given.stiffness(alpha)
    kind, xi = given.damping(("xi",))
    if kind == "e":
        xi = given.meeting("jankowski", xi) * math.sqrt((alpha + 1.0) / 2.5)
    common = given.common()
    return Jankowski(k=k, c=2.0 * xi * math.sqrt(scene.reduced_mass * k), alpha=alpha, **common)
