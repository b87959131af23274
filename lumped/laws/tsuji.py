"""Tsuji's model: F = k depth^alpha + c depth^((alpha - 1)/2) rate, c = alpha_t sqrt(m k), in approach and rebound.

Alpha = 3/2 in doi 10.1016/0032-5910(92)88030-L. In x = depth^((alpha + 1)/2) 2/(alpha + 1) the whole impact is a
damped linear oscillator, whatever the exponent. With `exit = "depth"` the damper pulls at the end.
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
    **damping_keys("alpha_t"),
    **formula_key("tsuji"),
    **COMMON,
}


@dataclass(frozen=True, kw_only=True)
class Tsuji(PowerLaw):
    """The law with k, N/m^alpha, and the damper's c, N s/m^((alpha + 1)/2)."""

    c: float
    alpha: float = 1.5
    name: ClassVar[str] = "tsuji"
    tensile: ClassVar[bool] = True

    def exponents(self, stage: Stage) -> tuple[float, ...]:
        """The spring's and the damper's."""
        return (self.alpha, 0.5 * (self.alpha - 1.0))

    def damper(self, depth: Any, rate: Any, stage: Stage) -> Any:
        """c depth^((alpha - 1)/2) rate."""
        return self.c * depth ** (0.5 * (self.alpha - 1.0)) * rate

    def damper_tangents(self, depth: Any, rate: Any, stage: Stage) -> tuple[Any, Any]:
        """Its slopes."""
        power = 0.5 * (self.alpha - 1.0)
        return self.c * power * depth ** (power - 1.0) * rate, self.c * depth**power


def of(scene: Scene) -> Tsuji:
    """The law for a scene. Raises BadInput.

    The oscillator's damping ratio is alpha_t/sqrt(2 (alpha + 1)): alpha_t grows with sqrt((alpha + 1)/2.5) at the
    same e.
    """
    given = Parameters(scene, Tsuji.name)
    alpha = given.exponent()
    k = given.stiffness(alpha)
    kind, alpha_t = given.damping(("alpha_t",))
    if kind == "e":
        alpha_t = given.meeting("tsuji", alpha_t) * math.sqrt((alpha + 1.0) / 2.5)
    common = given.common()
    return Tsuji(k=k, c=alpha_t * math.sqrt(scene.reduced_mass * k), alpha=alpha, **common)
