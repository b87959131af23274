"""Ting 1966: the exact impact on a viscoelastic half-space, doi 10.1115/1.3625192.

Contact that grows and shrinks once; the approach is that of the correspondence law, the rebound its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from lumped.laws._hereditary import Course, HereditaryLaw, Solve, simulate
from lumped.laws.base import LawKind, check_load_curve, waves
from lumped.result.history import End
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.solvers.hereditary import rebound as back
from lumped.solvers.hereditary.approach import DEPTH, approach
from lumped.solvers.hereditary.march import Settings
from lumped.solvers.hereditary.path import ByField, HereditaryPhase, SinceTouch
from lumped.solvers.hereditary.problem import Hereditary


@dataclass(frozen=True)
class Ting(HereditaryLaw):
    """The law; everything it needs is in the scene."""

    name: ClassVar[str] = "ting"

    @property
    def solve(self) -> Solve:
        """That of the whole contact."""
        return solve

    def simulate(self, scene: Scene, tolerance: float) -> Result:
        """One impact to this tolerance. Raises NotReached."""
        return simulate(self.name, scene, tolerance, solve)


def of(scene: Scene) -> Ting:
    """The law for a scene: every target with a load curve has it. Raises BadInput for one without."""
    check_load_curve(scene, Ting.name)
    scene.check_single(Ting.name)
    return Ting()


def solve(problem: Hereditary, end_time: float, settings: Settings, before: Course | None = None) -> Course:
    """One integration from touch to the end of contact, or to `end_time` in its own units. Raises NotReached."""
    inward = approach(problem, end_time, settings, before.inward if before else None)
    growing = HereditaryPhase(inward.path, SinceTouch(), DEPTH, DEPTH)
    if not inward.turned:
        return Course((growing,), End.REST if inward.rests else End.TIME, inward.steps, inward)
    known = before.outward if before and isinstance(before.outward, back.Rebound) else None
    outward = back.rebound(problem, inward, end_time, settings, known)
    shrinking = HereditaryPhase(outward.path, ByField(outward.path), back.DEPTH, back.EDGE)
    return Course((growing, shrinking), outward.end, inward.steps + outward.steps, inward, outward)


MEMBER = LawKind(of, __doc__, leaves_out=waves, seconds=0.008)
