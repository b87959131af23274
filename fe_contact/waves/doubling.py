"""The way of an impact whose waves run along a line: steps and elements are one, and doubled together.

The method that a target with waves takes by itself, as a witness of any other: two methods have one limit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import ClassVar

from fe_contact.budget.plan import Plan
from fe_contact.budget.refine import Finer
from fe_contact.progress import Progress
from fe_contact.settings import Numerics, WaveNumerics
from fe_contact.waves.rod_record import Line, Run
from lumped.result.model_ledger import Peak, model_ledger
from lumped.result.result import LedgerEntry, meets
from lumped.scene.scene import Scene

ROUNDS = 3  # refinements before giving up
STEP = 2_000  # unknowns whose share of a step takes as long as all the rest of it
MOST_WORK = 1e8  # unknowns, and those of a step itself, times steps, of all marches: some fifteen seconds


@dataclass(frozen=True, eq=False)
class Doubling:
    """``march`` of a scene with settings, and those with one cause of error ``varied`` at a time; ``most_steps``.

    ``dented``: whether what was found, a dent, says more of what the model leaves out than the plan. Each march is made
    once: with twice the steps, the one before is what half of them give.
    """

    scene: Scene
    chosen: Plan
    march: Callable[[WaveNumerics], Run]
    varied: Callable[[WaveNumerics], Mapping[str, WaveNumerics]]
    most_steps: float
    dented: bool
    progress: Progress
    runs: dict[WaveNumerics, Run] = field(default_factory=dict)
    rounds: ClassVar[int] = ROUNDS

    def certified(self, numerics: Numerics) -> Line:
        """The march and its variations. Raises NotReached where one does not end."""
        assert isinstance(numerics, WaveNumerics)
        self.progress(f"{numerics.steps} steps of waves along a line")
        others = self.varied(numerics)
        quarter = self._marched(self.varied(others["time_step"])["time_step"])
        fine, varied = self._marched(numerics), {cause: self._marched(other) for cause, other in others.items()}
        return Line(self.scene, numerics, fine, varied, quarter, tuple(self.runs.values()))

    def finer(self, found: Line) -> Finer:
        """Twice the steps, ``most_steps`` at most, where a bar is too wide and the work allows it."""
        twice = 2 * found.numerics.steps
        dear = _work(2 * found.fine.steps, 2 * found.fine.unknowns) + self._spent > MOST_WORK
        if "steps" in self.chosen.pinned or twice > self.most_steps or dear:
            return Finer(None)
        done = meets(found.quantities, found.numerics.tolerance)
        return Finer(None if done else found.numerics.varied(steps=twice))

    def ledger(self, found: Line) -> tuple[LedgerEntry, ...]:
        """What the model leaves out."""
        if not self.dented:
            return self.chosen.ledger
        return model_ledger(self.scene, Peak.of(found.quantities, found.history()))

    def _marched(self, numerics: WaveNumerics) -> Run:
        if numerics not in self.runs:
            self.runs[numerics] = self.march(numerics)
        return self.runs[numerics]

    @property
    def _spent(self) -> float:
        """Work of all marches so far."""
        return sum(_work(one.steps, one.unknowns) for one in self.runs.values())


def _work(steps: int, unknowns: int) -> float:
    """Of a march."""
    return float(steps) * (unknowns + STEP)


def witness(numerics: WaveNumerics, usual: Mapping[str, str]) -> dict[str, WaveNumerics]:
    """The same impact by the ``usual`` scheme, mass and enforcement, by the cause that errs where another is chosen.

    Half the steps alone do not tell: a method that chatters loses contact at once however short they are.
    """
    other = [key for key, name in usual.items() if getattr(numerics, key) != name]
    if not other:
        return {}
    return {"penalty" if "enforcement" in other else "mesh": numerics.varied(**usual)}
