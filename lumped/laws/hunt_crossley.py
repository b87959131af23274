"""Hunt and Crossley's model: F = k depth^alpha (1 + chi rate), alpha free, damped in approach and rebound.

Doi 10.1115/1.3423596. Of e, chi is the exact one unless `damping` names a published formula: all of
:mod:`lumped.restitution.hunt_crossley`. At a given chi the restitution falls with the velocity.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from lumped.laws._parameters import COMMON, EXPONENT, RESTITUTION, STIFFNESS, Parameters, damping_key, formula_key
from lumped.laws._power_law import SpringDamped
from lumped.laws.base import LawKind
from lumped.scene.scene import Scene
from lumped.solvers.point.bodies import Stage


@dataclass(frozen=True, kw_only=True)
class HuntCrossley(SpringDamped):
    """The law with k, N/m^alpha, and chi, s/m."""

    chi: float
    name: ClassVar[str] = "hunt_crossley"

    def factor(self, stage: Stage) -> float:
        """chi."""
        return self.chi


def of(scene: Scene) -> HuntCrossley:
    """The law for a scene. Raises BadInput."""
    given = Parameters(scene, HuntCrossley.name)
    alpha = given.exponent()
    k = given.stiffness(alpha)
    kind, chi = given.damping(("chi",))
    if kind == "e":
        chi = given.meeting("hunt_crossley", chi) / scene.velocity
    return HuntCrossley(k=k, chi=chi, alpha=alpha, **given.common())


MEMBER = LawKind(
    of,
    __doc__,
    (STIFFNESS, EXPONENT, RESTITUTION, damping_key("chi", "s/m"), formula_key("hunt_crossley"), COMMON),
)
