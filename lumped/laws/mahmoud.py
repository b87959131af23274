"""Mahmoud's modified Kelvin model: F = k depth + c rate while approaching, the spring alone in the rebound.

c = 2 xi sqrt(k m). The force jumps to c v at touch, and ends with the depth: both exits are one. Mahmoud and
Jankowski 2011, Iran. J. Sci. Technol. C 35, 51-62.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from lumped.laws._parameters import COMMON, RESTITUTION, STIFFNESS, Parameters, damping_key, formula_key
from lumped.laws._power_law import PowerLaw
from lumped.laws.base import LawKind
from lumped.numbers import Real
from lumped.scene.scene import Scene
from lumped.solvers.point.bodies import Stage


@dataclass(frozen=True, kw_only=True)
class Mahmoud(PowerLaw):
    """The law with stiffness k, N/m, and dashpot c, N s/m."""

    c: float
    alpha: float = 1.0
    name: ClassVar[str] = "mahmoud"

    def damper(self, depth: Real, rate: Real, stage: Stage) -> Real:
        """c rate in the approach."""
        return self.c * rate if stage.approaching else 0.0 * rate

    def damper_tangents(self, depth: Real, rate: Real, stage: Stage) -> tuple[Real, Real]:
        """0, c in the approach."""
        return 0.0, (self.c if stage.approaching else 0.0) + 0.0 * rate


def of(scene: Scene) -> Mahmoud:
    """The law for a scene. Raises BadInput."""
    given = Parameters(scene, Mahmoud.name)
    k = given.stiffness(1.0)
    return Mahmoud(k=k, c=given.dashpot(k), **given.common())


MEMBER = LawKind(
    of,
    __doc__,
    (STIFFNESS, RESTITUTION, damping_key("xi"), damping_key("c", "N s/m"), formula_key("mahmoud"), COMMON),
)
