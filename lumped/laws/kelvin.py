"""Kelvin's linear spring and dashpot, "(5)" to "(7)": F = k depth + c rate, c = 2 xi sqrt(k m).

The force jumps to c v at touch. With `exit = "force"` contact ends when it returns to zero; Anagnostopoulos'
damping "(7)" (1988, doi 10.1002/eqe.4290160312) belongs to `exit = "depth"`, where the dashpot may pull.
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
class Kelvin(PowerLaw):
    """The law with stiffness k, N/m, and dashpot c, N s/m."""

    c: float
    alpha: float = 1.0
    name: ClassVar[str] = "kelvin"
    tensile: ClassVar[bool] = True

    def damper(self, depth: Real, rate: Real, stage: Stage) -> Real:
        """c rate."""
        return self.c * rate

    def damper_tangents(self, depth: Real, rate: Real, stage: Stage) -> tuple[Real, Real]:
        """0, c."""
        return 0.0, self.c + 0.0 * rate


def of(scene: Scene) -> Kelvin:
    """The law for a scene. Raises BadInput."""
    given = Parameters(scene, Kelvin.name)
    k = given.stiffness(1.0)
    return Kelvin(k=k, c=given.dashpot(k), **given.common())


MEMBER = LawKind(
    of,
    __doc__,
    (STIFFNESS, RESTITUTION, damping_key("xi"), damping_key("c", "N s/m"), formula_key("kelvin"), COMMON),
)
