"""From a plan to the record of an impact: what finite elements need to know to answer one kind of model."""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

import numpy as np

from fe_contact.budget.budget import Budget, Solution, shares_of
from fe_contact.budget.plan import Plan
from fe_contact.budget.refine import ImpactWay, refine
from fe_contact.budget.several import Row, Several
from fe_contact.budget.variation import Softening, Variation
from fe_contact.march.impacts import UNFOLLOWED
from fe_contact.progress import Count, Progress
from fe_contact.settings import RANGES, Given
from lumped.numbers import Clock
from lumped.progress import counting_steps
from lumped.result.result import UNITS, IndentationLeft, Result, largest_bar, provenance, unmet
from lumped.scene.scene import Scene

LOOSER = "a larger tolerance"
NONE_MET = "no tolerance that is accepted is met"
SOONER = "a shorter motion.end_time"  # as where a dashpot alone is watched long after the peak
NO_CURE = "no setting is known to help"
HIGHER, NONE_GIVEN = "a higher numerics.{}", "no numerics.{} of your own"
# What takes from a cause where a user holds the setting, which else is refined, or chosen well.
HELD = {
    "mesh": {"elements_per_contact": HIGHER, "order": HIGHER},
    "penalty": {"penalty": HIGHER, "enforcement": NONE_GIVEN},
    "time_step": {"steps": HIGHER, "scheme": NONE_GIVEN},
    "far_field": {"far_radius": HIGHER},
}

Answer = TypeVar("Answer", bound=Solution, covariant=True)
AnyAnswer = TypeVar("AnyAnswer", bound=Solution)


@dataclass(frozen=True)
class SolvedBy(Generic[Answer]):
    """A certified impact with the plan it began from; ``timing``: processor and wall time, s.

    ``refused``: why no finer settings were tried that may have met the tolerance; empty where none was refused.
    """

    plan: Plan
    certified: Answer
    timing: Mapping[str, float]
    refused: str


@dataclass(frozen=True)
class ImpactModel:
    """How finite elements answer one kind of model: without waves, with them, with large strains, with yield.

    ``check(scene, given)`` raises BadInput for an impact that it does not answer; ``plan(scene, given)``: settings and
    ledger; ``expected(scene, given)``: tolerance, and processor time, s, about, once packages are loaded;
    ``fe(scene, given, progress)``: the force history and its bars, of a scene that was checked.
    """

    check: Callable[[Scene, Given], None]
    plan: Callable[[Scene, Given], Plan]
    expected: Callable[[Scene, Given], tuple[float, float]]
    fe: Callable[[Scene, Given, Progress], Result]


def planned(scene: Scene, given: Given, progress: Progress, plan: Callable[[Scene, Given], Plan]) -> Plan:
    """Settings and ledger; the steps of what is run for them are told. Raises NotReached."""
    with counting_steps(Count.of(progress, "what to expect of the contact", 0.0)):
        return plan(scene, given)


def solved(
    scene: Scene,
    given: Given,
    progress: Progress,
    plan: Callable[[Scene, Given], Plan],
    way_of: Callable[[Scene, Plan, Progress], ImpactWay[AnyAnswer]],
) -> SolvedBy[AnyAnswer]:
    """Plan, certify, refine until the bars meet the tolerance or nothing is left to refine. Raises NotReached."""
    clock = Clock()
    chosen = planned(scene, given, progress, plan)
    way = way_of(scene, chosen, progress)
    found, refused = refine(way, chosen.numerics)
    chosen = replace(chosen, ledger=way.ledger(found))
    return SolvedBy(chosen, found, clock.read(), refused)


def record(scene: Scene, solved: SolvedBy[Solution], recovery: IndentationLeft | None = None) -> Result:
    """The record of a certified impact, or of several, and of the indentation left where it is known."""
    found = solved.certified
    if isinstance(found, Several) and scene.motion.impacts > 1:
        found = Row(found)
    by_quantity = {name: {cause: found.error(name, cause) for cause in found.causes} for name in UNITS}
    peak = found.quantities["peak_force"].value or np.inf
    missed = _missed(scene, solved, found)
    said = [*missed]
    if found.grounded is not None:
        said.append(f"contacts followed: {len(found.parts)} of {scene.motion.impacts}; {found.grounded.value}")
    return Result(
        method="fe",
        converged=not missed and found.grounded not in UNFOLLOWED,
        separated=found.separated,
        scene=scene,
        model=scene.model,
        tolerance=found.numerics.tolerance,
        history=found.history(),
        quantities=found.quantities,
        numerics=found.numerics.as_dict(),
        error_budget={cause: value / peak for cause, value in by_quantity["peak_force"].items()},
        error_budget_by_quantity=by_quantity,
        model_ledger=solved.plan.ledger,
        energy=found.energy,
        energy_error=found.energy_errors,
        provenance=provenance(),
        timing=solved.timing,
        work=found.counted,
        contacts=found.contacts,
        message="; ".join(said),
        recovery=recovery,
    )


def dent_left(found: Solution) -> IndentationLeft | None:
    """What is left for ever of an impact on what yields, with its bar: nothing recovers. None where nothing yields."""
    if not isinstance(found, Budget) or found.curve.dent is None:
        return None
    left = found.curve.dent
    apart = sum(_apart(change) for causes in found.changes.values() for change in causes)
    return IndentationLeft(np.zeros(1), np.array([left]), np.array([apart]), left, ())


def _apart(change: Variation | Softening | None) -> float:
    """What a change moves a dent, m; infinite where it failed."""
    if not isinstance(change, Variation) or change.first.dent is None or change.second.dent is None:
        return math.inf
    return change.factor * abs(change.first.dent - change.second.dent)


def _missed(scene: Scene, solved: SolvedBy[Solution], found: Solution) -> list[str]:
    """What bars exceed the tolerance, what kept them from being refined, the tolerance that is met, and the cure."""
    tolerance = found.numerics.tolerance
    missed = [unmet(part, tolerance) for part in found.parts]
    if scene.motion.impacts > 1:
        missed = [f"contact {number}: {words}" for number, words in enumerate(missed, start=1) if words]
    if not any(missed):
        return []
    largest = max(largest_bar(part) for part in found.parts)
    met = 10.0 ** (math.ceil(10.0 * math.log10(largest)) / 10.0) if math.isfinite(largest) else None  # rounded up
    none = met is not None and met > RANGES["tolerance"][1]
    reached = "" if met is None else NONE_MET if none else f"a tolerance of {met:.2g} is met"
    cause = max(found.causes, key=lambda one: float(shares_of(found, one).max()))
    said = [*missed, f"the largest cause is the {cause.replace('_', ' ')}", solved.refused, reached]
    cures = _cures(found, cause, solved.plan.pinned, none)
    return [*filter(None, said), f"cure: {', or '.join(cures)}" if cures else NO_CURE]


def _cures(found: Solution, cause: str, pinned: Container[str], none_met: bool) -> list[str]:
    """What brings the bars within the tolerance, or takes from the largest cause of what they miss.

    A larger tolerance is met, or asks for other settings, unless it was the largest, or one's own stand against it.
    """
    own = [how.format(key) for key, how in HELD.get(cause, {}).items() if key in pinned]
    if not none_met:
        return [LOOSER, *own]
    if not found.separated:
        return [*own, SOONER]
    looser = not own and found.numerics.tolerance < RANGES["tolerance"][1]
    return own or ([LOOSER] if looser else [])
