"""The way with waves: a march is dear, so that no more is refined than the measured budget says is missing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fe_contact.budget.budget import shares_of
from fe_contact.budget.plan import Plan
from fe_contact.budget.refine import Finer, Growth, missing
from fe_contact.budget.several import Several
from fe_contact.progress import Count, Progress
from fe_contact.settings import Numerics, WaveNumerics
from fe_contact.steppers.march import Strike
from fe_contact.waves.certify import ORDER, WaveRuns, certify, other_mesh
from fe_contact.waves.cost import Cost
from fe_contact.waves.moving import Moving
from lumped.result.result import LedgerEntry, meets
from lumped.scene.scene import Scene

ROUNDS = 3  # refinements before giving up
GROWTH = {
    "mesh": Growth(ORDER["mesh"], step=2**0.25, most=2.0, work=2.0),
    "penalty": Growth(ORDER["penalty"], step=2.0, most=8.0, work=0.1),
    "time_step": Growth(ORDER["time_step"], step=2.0, most=4.0, work=1.0),  # half of twice as many has been run
    "far_field": Growth(ORDER["far_field"], step=2.0, most=4.0, work=0.3),
}

Body = Callable[[Scene, WaveNumerics], Moving]


@dataclass(frozen=True, eq=False)
class Waves:
    """A scene whose body ``moving`` makes; its runs are kept, as a finer budget asks for some of them again."""

    scene: Scene
    chosen: Plan
    moving: Body
    progress: Progress
    runs: WaveRuns
    rounds: ClassVar[int] = ROUNDS

    @classmethod
    def of(cls, scene: Scene, chosen: Plan, moving: Body, progress: Progress) -> Waves:
        """Nothing is run yet."""
        return cls(
            scene, chosen, moving, progress, WaveRuns(scene, Strike.of(scene), moving, chosen.numerics.steps // 2)
        )

    def certified(self, numerics: Numerics) -> Several:
        """A contact, or several, and the bars.

        Raises NotReached where no march ends or the budget costs too much, BadInput for an impact that goes deeper than
        its bodies.
        """
        assert isinstance(numerics, WaveNumerics)
        cost = cost_of(self.scene, numerics, self.moving)
        cost.check(self.runs.spent)
        self.progress(f"waves, {cost}")
        self.runs.counted = Count(self.progress, f"waves, {cost.unknowns} unknowns", cost.all_steps)
        found = certify(self.runs, numerics)
        self.scene.check_sunk(max(budget.curve.quantities["peak_depth"] or 0.0 for budget in found.row))
        return found

    def finer(self, found: Several) -> Finer:
        """Settings whose bars are predicted to meet the tolerance."""
        if all(meets(part, found.numerics.tolerance) for part in found.parts):
            return Finer(None)
        shares = {cause: np.concatenate([shares_of(one, cause) for one in found.row]) for cause in GROWTH}
        finer = missing(shares, GROWTH, found.numerics, self.chosen.pinned)
        return Finer(None if finer == found.numerics else finer)

    def ledger(self, found: Several) -> tuple[LedgerEntry, ...]:
        """What the model leaves out, as was planned."""
        return self.chosen.ledger


def cost_of(scene: Scene, numerics: WaveNumerics, moving: Body) -> Cost:
    """What one error budget costs with these settings. Raises BodyTooFine."""
    own, judging = (moving(scene, one).body.size for one in (numerics, other_mesh(numerics)[0]))
    return Cost.of(own, numerics, scene.motion.impacts, judging if judging > own else 0)
