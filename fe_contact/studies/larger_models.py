"""What a scene's model leaves out, measured: the next larger model run beside it, and the smallest that is sufficient.

An estimate of the model ledger is a formula. Where it names a key, the larger model can be asked instead: one coarse
run with the key, one without, both by finite elements with their error bars, and the change of the peak force between
them. No key draws a section out to free ends: what these change is measured at rest, at the peak depth. Which effects a
scene needs follows from the ledger alone, before anything is run.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace

from fe_contact.budget.plan import scales
from fe_contact.errors import faults_of
from fe_contact.indentation import settings
from fe_contact.large_strains import check_range
from fe_contact.progress import Progress, silent
from fe_contact.reference import check, expected, fe, plan, with_waves
from fe_contact.settings import Given, WaveNumerics, tolerance_of
from fe_contact.studies.finite_length import free_ends
from lumped.errors import FeContactError
from lumped.materials.energies.base import DEFAULT
from lumped.result.model_ledger import FINITE_LENGTH
from lumped.result.result import NO_KEY, LedgerEntry, Quantity, Result, good_to, percent
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Scene
from lumped.schema import Table

# The tolerance of both runs is a third of the effect that they are to show, within what waves reach and what is cheap.
SHARE, FINEST, COARSEST = 3.0, 3e-3, 3e-2
AT_DEPTH = "of the force at the peak depth, at small strains"


@dataclass(frozen=True)
class MeasuredEffect:
    """An effect that the ledger estimates, or its ``spread``, as two runs find it: ``change`` of the peak force and
    its ``error``, all relative; None, and the ``reason``, where the larger model has no answer. ``note``: of what else
    it is the change; ``budget`` of its error, by cause, where it is told.
    """

    effect: str
    setting: str
    estimate: float | None
    change: float | None = None
    error: float | None = None
    reason: str = ""
    spread: tuple[float, float] | None = None
    note: str = ""
    budget: Mapping[str, float] | None = None

    def __str__(self) -> str:
        if self.spread is not None:
            estimate = " to ".join(map(_signed, self.spread))
        else:
            estimate = "none" if self.estimate is None else percent(self.estimate)
        if self.change is None or self.error is None:
            return f"{self.effect}: estimate {estimate} | not measured: {self.reason}"
        by = "" if self.spread is None else f"by {DEFAULT} where the scene names no energy"
        found = ", ".join(filter(None, (f"measured {_signed(self.change)} +- {percent(self.error)}", by, self.note)))
        asked = f" ({self.setting})" if self.setting else ""
        return f"{self.effect}{asked}: estimate {estimate} | {found}"

    def to_json(self) -> Table:
        """Its fields."""
        return asdict(self)


def _signed(change: float) -> str:
    """A change of the peak force in words."""
    return f"{'' if change < 0.0 else '+'}{percent(change)}"


@dataclass(frozen=True)
class SufficientModel:
    """A scene with every effect that certainly exceeds the tolerance, as far as there is a model of it.

    ``taken``: those entries; ``left``: the ones above the tolerance all the same, each with the reason; ``open``: what
    may exceed it, and the scene does not decide.
    """

    scene: Scene
    taken: tuple[LedgerEntry, ...] = ()
    left: Mapping[str, str] = field(default_factory=dict)
    open: tuple[LedgerEntry, ...] = ()

    def __str__(self) -> str:
        took = [f"{entry.effect} ({entry.setting}), estimated {percent(entry.size)}" for entry in self.taken]
        said = f"the model takes in {', '.join(took)}" if took else "the model is the scene's own"
        left = [f"{effect} is left out: {reason}" for effect, reason in self.left.items()]
        undecided = [f"{entry.effect} is open: {entry.note}; {entry.cure}" for entry in self.open]
        return "; ".join([said, *left, *undecided])

    def less(self, own: Scene, refused: FeContactError) -> SufficientModel:
        """Without the effect taken in last into the scene's ``own`` model, with which no answer was found."""
        *taken, last = self.taken
        scene, left = own.changed({one.key: one.value for one in taken}), {last.effect: _not_taken(last, refused)}
        return replace(self, scene=scene, taken=tuple(taken), left={**self.left, **left})


def above(ledger: Sequence[LedgerEntry], tolerance: float) -> list[LedgerEntry]:
    """Effects that exceed the tolerance certainly or possibly, and have a larger model, the largest first."""
    found = [entry for entry in ledger if entry.key and entry.size > tolerance]
    return sorted(found, key=lambda entry: -entry.size)


def measure(scene: Scene, given: Given, progress: Progress = silent) -> tuple[MeasuredEffect, ...]:
    """Every effect above the tolerance that has a larger model, by one coarse run each, and what free ends change.

    Raises BadInput, NotReached.
    """
    tolerance, ledger = tolerance_of(given), plan(scene, given).ledger
    ended = [entry for entry in ledger if entry.effect == FINITE_LENGTH and entry.size > tolerance]
    return (
        *_by_runs(scene, given, above(ledger, tolerance), progress),
        *(_at_rest(scene, one, progress) for one in ended),
    )


def measured_lines(measured: Sequence[MeasuredEffect], ledger: Sequence[LedgerEntry]) -> list[str]:
    """What was measured, and how good the model is by it; where the scene does not decide, the estimate counts."""
    if not measured:
        return ["measured, as a change of the peak force:", "  no effect above the tolerance has a larger model"]
    most = {one.effect: abs(one.change) + one.error for one in measured if one.change is not None and one.error}
    known = [replace(one, estimate=most.get(one.effect, one.estimate)) if one.spread is None else one for one in ledger]
    found = ["measured, as a change of the peak force:", *(f"  {one}" for one in measured)]
    return [*found, f"by what was measured, bars added, {good_to(known)}"]


def _by_runs(
    scene: Scene, given: Given, effects: Sequence[LedgerEntry], progress: Progress
) -> tuple[MeasuredEffect, ...]:
    """What has a key, each by two runs."""
    if not effects:
        return ()
    finest = min(_tolerance_of(entry) for entry in effects)
    progress("the scene's own model")
    own = fe(scene, {**given, "tolerance": finest})
    found = []
    for count, entry in enumerate(effects):
        progress(f"with {entry.effect}", count, len(effects))
        found.append(_measured(scene, entry, own))
    return tuple(found)


def _tolerance_of(entry: LedgerEntry) -> float:
    return min(max(entry.size / SHARE, FINEST), COARSEST)


def _measured(scene: Scene, entry: LedgerEntry, own: Result) -> MeasuredEffect:
    """By the larger model, with settings of its own."""
    without = MeasuredEffect(entry.effect, entry.setting, entry.estimate, spread=entry.spread)
    try:
        larger = fe(scene.changed({entry.key: entry.value}), {"tolerance": _tolerance_of(entry)})
        change, error = change_of(own.quantities["peak_force"], larger.quantities["peak_force"])
    except FeContactError as refused:
        return replace(without, reason=str(refused))
    return replace(without, change=change, error=error)


def _at_rest(scene: Scene, entry: LedgerEntry, progress: Progress) -> MeasuredEffect:
    """What free ends change at the depth that the plan expects."""
    without = MeasuredEffect(entry.effect, "", entry.estimate, note=AT_DEPTH)
    geometry = scene.geometry
    indenter = Indenter(scene.profile, geometry.material, geometry.target, source=scene.source)
    try:
        found = free_ends(indenter, scales(scene, settings({}, scene.profile)).peak_depth, progress)
    except FeContactError as refused:
        return replace(without, reason=str(refused))
    return replace(without, change=found.change, error=found.error, budget=found.budget)


def change_of(own: Quantity, larger: Quantity) -> tuple[float, float]:
    """Relative change of a quantity and what both bars leave open of it."""
    ours, theirs = own.value or math.nan, larger.value or math.nan
    ratio = theirs / ours
    return ratio - 1.0, ((larger.error or 0.0) + ratio * (own.error or 0.0)) / ours


def sufficient(scene: Scene, given: Given) -> SufficientModel:
    """The smallest set of effects with which nothing that can be judged exceeds the tolerance.

    Each effect is judged by its own estimate, so that the set is that of all which exceed it; an effect taken in may
    change the others' estimates, and the ledger is asked again. Raises BadInput, NotReached.
    """
    tolerance = tolerance_of(given)
    taken, left = list[LedgerEntry](), dict[str, str]()
    while True:
        ledger = plan(scene, given).ledger
        needed = [entry for entry in ledger if entry.exceeds(tolerance) and entry.effect not in left]
        if not needed:
            undecided = [one for one in above(ledger, tolerance) if not one.exceeds(tolerance)]
            return SufficientModel(scene, tuple(taken), left, tuple(undecided))
        entry = max(needed, key=lambda one: one.size)
        if not entry.key:
            left[entry.effect] = f"about {percent(entry.size)} of the peak force, {NO_KEY}: {entry.note}"
            continue
        try:
            scene = _answered(scene.changed({entry.key: entry.value}), given)
            taken.append(entry)
        except FeContactError as refused:
            left[entry.effect] = _not_taken(entry, refused)


def _not_taken(entry: LedgerEntry, refused: FeContactError) -> str:
    return f"about {percent(entry.size)} of the peak force, and cannot be taken in: {refused}"


def _answered(scene: Scene, given: Given) -> Scene:
    """The scene, where finite elements have an answer to it. Raises BadInput, NotReached."""
    with faults_of(scene):
        expected(scene, given)
        check(scene, given)
        check_range(scene)
        numerics = plan(scene, given).numerics
        if isinstance(numerics, WaveNumerics):
            with_waves(scene).cost(scene, numerics).check()
    return scene
