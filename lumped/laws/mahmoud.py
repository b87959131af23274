"""Mahmoud's modified Kelvin model: F = k depth + c rate while approaching, the spring alone in the rebound.

c = 2 xi sqrt(k m). The force jumps to c v at touch, and ends with the depth: both exits are one. Mahmoud and
Jankowski 2011, Iran. J. Sci. Technol. C 35, 51-62.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from lumped.laws._parameters import COMMON, RESTITUTION, STIFFNESS, Parameters, damping_keys, formula_key
from lumped.laws._power_law import PowerLaw
from lumped.scene.scene import Scene
from lumped.schema.keys import Key
from lumped.solvers.point.bodies import Stage

KEYS: Mapping[str, Key] = {
    **STIFFNESS,
    **RESTITUTION,
    **damping_keys("xi"),
    **damping_keys("c", unit="N s/m"),
    **formula_key("mahmoud"),
    **COMMON,
}


@dataclass(frozen=True, kw_only=True)
class Mahmoud(PowerLaw):
    """The law with stiffness k, N/m, and dashpot c, N s/m."""

    c: float
    alpha: float = 1.0
    name: ClassVar[str] = "mahmoud"

    def damper(self, depth: Any, rate: Any, stage: Stage) -> Any:
        """c rate in the approach."""
        return self.c * rate if stage.approaching else 0.0 * rate

    def damper_tangents(self, depth: Any, rate: Any, stage: Stage) -> tuple[Any, Any]:
        """0, c in the approach."""
        return 0.0, (self.c if stage.approaching else 0.0) + 0.0 * rate


def of(scene: Scene) -> Mahmoud:
    """The law for a scene. Raises BadInput."""
    given = Parameters(scene, Mahmoud.name)
    k = given.stiffness(1.0)
    return Mahmoud(k=k, c=given.dashpot(k), **given.common())
