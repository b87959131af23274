"""Muthukumar and DesRoches' Hertzdamp: F = k depth^alpha (1 + xi rate/v0), v0 the velocity at touch.

Doi 10.1002/eqe.557; the law of Hunt and Crossley with a damping that follows the velocity, so that the restitution
does not depend on it. Of e, xi is the exact one unless `damping` names a published formula: theirs is `muthukumar`,
3 (1-e^2)/4, and OpenSees recommends `ye`, 8 (1-e)/(5 e).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from lumped.laws._parameters import Parameters, damped, damping_key
from lumped.laws._power_law import SpringDamped
from lumped.laws.base import LawKind
from lumped.laws.hunt_crossley import FAMILY
from lumped.scene.scene import Scene
from lumped.solvers.point.bodies import Stage


@dataclass(frozen=True, kw_only=True)
class Hertzdamp(SpringDamped):
    """The law with k, N/m^alpha, and xi."""

    xi: float
    name: ClassVar[str] = "hertzdamp"

    def factor(self, stage: Stage) -> float:
        """xi/v0, v0 that of this contact."""
        return self.xi / stage.speed


def of(scene: Scene) -> Hertzdamp:
    """The law for a scene. Raises BadInput."""
    given = Parameters(scene, Hertzdamp.name)
    numbers = given.spring_damper(FAMILY, "xi", lambda d, k: d)
    return Hertzdamp(**numbers, **given.common())


MEMBER = LawKind(of, __doc__, damped(FAMILY, damping_key("xi")))
