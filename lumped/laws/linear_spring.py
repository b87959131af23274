"""The linear spring, "(3)": F = k depth, nothing is lost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from lumped.collide.bodies import Stage
from lumped.keys import Key
from lumped.laws._parameters import COMMON, STIFFNESS, Parameters
from lumped.laws._power_law import PowerLaw
from lumped.scene import Scene

KEYS: Mapping[str, Key] = {**STIFFNESS, **COMMON}


@dataclass(frozen=True, kw_only=True)
class LinearSpring(PowerLaw):
    """The law with its stiffness k, N/m."""

    alpha: float = 1.0
    name: ClassVar[str] = "linear_spring"

    def damper(self, depth: Any, rate: Any, stage: Stage) -> Any:
        """None."""
        return 0.0 * depth

    def damper_tangents(self, depth: Any, rate: Any, stage: Stage) -> tuple[Any, Any]:
        """None."""
        return 0.0, 0.0 * depth


def of(scene: Scene) -> LinearSpring:
    """The law for a scene. Raises BadInput."""
    given = Parameters(scene, LinearSpring.name)
    return LinearSpring(k=given.stiffness(1.0), **given.common())
