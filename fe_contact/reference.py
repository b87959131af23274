"""The finite-element reference: plan, certify, refine what dominates until the bars meet the tolerance."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar, Generic, TypeVar

import numpy as np

from fe_contact.assembly.forms import check_compressible
from fe_contact.budget import plan as statics
from fe_contact.budget.budget import CAUSES, Budget, Solution, shares_of
from fe_contact.budget.certify import Certified, certify
from fe_contact.budget.plan import Plan
from fe_contact.budget.refine import Finer, Growth, ImpactWay, missing, refine
from fe_contact.budget.runs import operations
from fe_contact.budget.several import Row, Several
from fe_contact.errors import faults_of
from fe_contact.march.impacts import UNFOLLOWED
from fe_contact.progress import Progress, silent
from fe_contact.recovery import indentation_left, recovers
from fe_contact.settings import DEFAULT_TOLERANCE, Given, Numerics, WaveNumerics, check_kind
from fe_contact.steppers.steps import Strike
from fe_contact.targets.base import TARGETS, seconds_of_impact, struck
from lumped.errors import BadInput, Fault
from lumped.numbers import Clock
from lumped.result.result import (
    UNITS,
    LedgerEntry,
    Result,
    largest_bar,
    meets,
    provenance,
    unmet,
)
from lumped.scene.scene import Scene

if TYPE_CHECKING:
    from fe_contact.waves.targets.base import WaveTarget

CURE = "cure: a larger tolerance, or fewer numerics of your own"
ROUNDS = 4  # refinements before giving up
# Where an edge crosses elements bars fall with the mesh to 1.5; extrapolated steps err by order two at least. What an
# edge does by chance changes bars by a half: smaller steps than these may find nothing better, and a round of larger
# ones may not be afforded.
GROWTH = {
    "mesh": Growth(order=1.5, step=1.5, most=1.5, work=2.0),
    "penalty": Growth(order=1.0, step=2.0, most=4.0, work=0.1),
    "time_step": Growth(order=2.0, step=2.0, most=2.0, work=0.7),
    "far_field": Growth(order=2.0, step=2.0, most=2.0, work=0.3),
}
MOST_STEPS = 20_000  # of all marches of a round, about half a minute; the next one may take twice as many
MOST_OPERATIONS = 5e12  # of a round, half a minute to two: contact problems reach 5e10 to 2e11 a second

Answer = TypeVar("Answer", bound=Solution, covariant=True)


@dataclass(frozen=True)
class SolvedBy(Generic[Answer]):
    """A certified impact with the plan it began from; ``timing``: processor and wall time, s.

    ``refused``: why no finer settings were tried that may have met the tolerance; empty where none was refused.
    """

    plan: Plan
    certified: Answer
    timing: Mapping[str, float]
    refused: str

    @property
    def numerics(self) -> Numerics:
        """The settings it ended with."""
        return self.certified.numerics


Solved = SolvedBy[Certified]  # without waves


def fe(scene: Scene, given: Given, progress: Progress = silent) -> Result:
    """Force history of a scene by finite elements, with waves or without, and error bars; see :func:`solve`."""
    if scene.model.plasticity:
        from fe_contact.plastic import impact as yielding  # late, as all that follows: few impacts need it

        with faults_of(scene):
            flowed = _solved(scene, given, progress, yielding.Striking.of)
        return result_of(scene, flowed)
    if scene.model.finite and scene.geometry.material.young.is_elastic:
        from fe_contact import large_strains

        return large_strains.fe(scene, given, progress)
    check(scene, given)
    if scene.model.finite:
        from fe_contact import relaxing_impact

        with faults_of(scene):
            marched = _solved(scene, given, progress, relaxing_impact.RelaxingStrikes)
        return result_of(scene, marched)
    if not scene.model.inertia:
        solved = _solved(scene, given, progress, Statics.of)
        return result_of(scene, solved)
    return result_of(scene, _solved(scene, given, progress, with_waves(scene).way))


def with_waves(scene: Scene) -> WaveTarget:
    """What strikes or is struck with inertia. Raises BadInput."""
    from fe_contact.waves.targets.base import WAVES  # late: few impacts need it

    return WAVES.get(scene.target.name)


def plan(scene: Scene, given: Given) -> Plan:
    """Choose what ``given`` (checked settings, see :func:`fe_contact.settings.checked`) leaves open.

    Raises NotReached where even a coarse estimate does not come to an end.
    """
    with faults_of(scene):
        if scene.model.plasticity:
            from fe_contact.plastic import impact as yielding

            return yielding.plan(scene, given)
        if scene.model.finite:
            from fe_contact import large_strains, relaxing_impact

            large_strains.check_impact(scene, given)
            if not scene.geometry.material.young.is_elastic:
                return relaxing_impact.plan(scene, given)
        if not scene.model.inertia:
            return statics.plan(scene, given)
        check_kind(given, True, scene.source)
        return with_waves(scene).plan(scene, given)


def solve(scene: Scene, given: Given, progress: Progress = silent) -> Solved:
    """Plan, certify, refine until the bars meet the tolerance or nothing is left to refine; without waves.

    Parameters
    ----------
    scene : physics.
    given : checked settings that the plan must keep.
    progress : told what happens, and the steps done of those expected.

    Raises NotReached where no march came to an end, BadInput for a scene without geometry, of several impacts on a body
    that does not remember by its surface alone, or that goes deeper than its bodies.
    """
    with faults_of(scene):
        check_target(scene)
        return _solved(scene, given, progress, Statics.of)


def _solved(
    scene: Scene,
    given: Given,
    progress: Progress,
    way_of: Callable[[Scene, Plan, Progress], ImpactWay[Answer]],
) -> SolvedBy[Answer]:
    clock = Clock()
    progress("what to expect of the contact")
    chosen = plan(scene, given)
    way = way_of(scene, chosen, progress)
    found, refused = refine(way, chosen.numerics)
    chosen = replace(chosen, ledger=way.ledger(found))
    return SolvedBy(chosen, found, clock.read(), refused)


@dataclass(frozen=True, eq=False)
class Statics:
    """The way without waves: every round a budget of its own."""

    scene: Scene
    chosen: Plan
    progress: Progress
    rounds: ClassVar[int] = ROUNDS

    @classmethod
    def of(cls, scene: Scene, chosen: Plan, progress: Progress) -> Statics:
        """Raises BadInput for several impacts on a body that does not remember by its surface alone."""
        if scene.motion.impacts > 1 and not struck(scene.geometry, chosen.numerics).recovers:
            scene.check_single("fe, on what remembers by its bulk or by two surfaces,")
        return cls(scene, chosen, progress)

    def certified(self, numerics: Numerics) -> Certified:
        """A contact, or several, and the bars. Raises BadInput for one deeper than its bodies."""
        scene = self.scene
        found = certify(Strike.of(scene), scene.geometry, numerics, scene.motion.impacts, self.progress)
        for curve in (budget.curve for budget in found.row):
            scene.check_sunk(curve.quantities["peak_depth"] or 0.0, float(np.sqrt(curve.radius_squared.max())))
        return found

    def finer(self, found: Certified) -> Finer:
        """Less of the causes that stand in the way, unless that is not to be afforded."""
        tolerance = found.numerics.tolerance
        if all(meets(part, tolerance) for part in found.parts):
            return Finer(None)
        shares = {cause: np.concatenate([shares_of(one, cause) for one in found.row]) for cause in CAUSES}
        settings = missing(shares, GROWTH, found.numerics, self.chosen.pinned)
        return Finer(settings, "" if settings is None else _too_dear(found, settings))

    def ledger(self, found: Certified) -> Sequence[LedgerEntry]:
        """What the model leaves out, as was planned."""
        return self.chosen.ledger


def _too_dear(certified: Certified, finer: Numerics) -> str:
    """Why a round of finer settings is not to be afforded, from what the last one took; empty where it is.

    Steps count in proportion, and the nodes in the contact zone, which are as many as the elements, by their cube.
    """
    numerics = certified.numerics
    longer = finer.steps / numerics.steps
    steps = longer * certified.work.steps
    if steps > MOST_STEPS:
        return f"finer settings take about {steps:.0f} steps: accepted up to {MOST_STEPS}"
    wider = finer.elements_per_contact / numerics.elements_per_contact
    work = longer * wider**3 * operations(certified.work, certified.surface)
    if work > MOST_OPERATIONS:
        return f"finer settings take about {work:.2g} operations: accepted up to {MOST_OPERATIONS:.0e}"
    return ""


def expected(scene: Scene, given: Given) -> tuple[float, float]:
    """Tolerance, and processor time, s, about, of :func:`fe` once packages are loaded. Raises NotReached, BadInput."""
    with faults_of(scene):
        if scene.model.finite:
            from fe_contact import large_strains, relaxing_impact

            large_strains.check_impact(scene, given)
            seconds = large_strains if scene.geometry.material.young.is_elastic else relaxing_impact
            return float(given.get("tolerance", DEFAULT_TOLERANCE)), seconds.SECONDS
        if scene.model.inertia:
            target, chosen = with_waves(scene), plan(scene, given).numerics
            assert isinstance(chosen, WaveNumerics)
            return chosen.tolerance, target.cost(scene, chosen).seconds
        tolerance = float(given.get("tolerance", DEFAULT_TOLERANCE))
        if scene.model.plasticity:
            from fe_contact.plastic import impact as yielding

            return tolerance, yielding.SECONDS
        check_target(scene)
        tighter = max(DEFAULT_TOLERANCE / tolerance, 1.0)
        return tolerance, scene.motion.impacts * tighter * seconds_of_impact(scene.geometry)


def check(scene: Scene, given: Given) -> None:
    """Raise BadInput for an impact that finite elements do not answer."""
    if scene.model.finite:
        from fe_contact import large_strains

        large_strains.check_impact(scene, given)
    elif scene.model.inertia:
        with_waves(scene).check(scene)
    elif not scene.model.plasticity:
        check_target(scene)


def check_target(scene: Scene) -> None:
    """Raise BadInput for a target which no impact is marched on, and for what is found elsewhere: waves, flow."""
    geometry = scene.geometry
    check_compressible(scene)
    if scene.model.plasticity:
        reason = "true: this command does not know it in this version; accepted: false, or fe-contact run"
        raise BadInput(Fault(scene.source, "model.plasticity", reason))
    if scene.model.finite:
        reason = "finite: this command is for small displacements in this version; accepted: small, or fe-contact run"
        raise BadInput(Fault(scene.source, "model.kinematics", reason))
    if scene.model.inertia:
        reason = "true: this command is without waves in this version; accepted: false, or fe-contact run"
        raise BadInput(Fault(scene.source, "model.inertia", reason))
    fixed = geometry.target.fixed_radius(geometry.shape) is not None
    if not fixed and TARGETS.get(geometry.target.name).struck is None:
        reason = f"no impact on {geometry.target.name} by finite elements in this version; accepted: indent"
        raise BadInput(Fault(scene.source, "target.shape", reason))
    if not geometry.surface_remembers and TARGETS.get(geometry.target.name).relaxing is None:
        reason = f'"bulk": no impact on {geometry.target.name} with it in this version; accepted: "poisson"'
        raise BadInput(Fault(scene.source, "target.material.constant", reason))


def result_of(scene: Scene, solved: SolvedBy[Solution]) -> Result:
    """The record of a certified impact, or of several."""
    found, recovery = solved.certified, None
    if isinstance(found, Several) and len(found.row) == 1 and recovers(scene, found.curve):
        recovery = indentation_left(found)
    if isinstance(found, Budget) and scene.model.plasticity:
        from fe_contact.plastic import impact as yielding

        recovery = yielding.dent(found)
    if isinstance(found, Several) and scene.motion.impacts > 1:
        found = Row(found)
    by_quantity = {name: {cause: found.error(name, cause) for cause in CAUSES} for name in UNITS}
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
    said = [*missed, solved.refused, "" if met is None else f"a tolerance of {met:.2g} is met", CURE]
    return [part for part in said if part]
