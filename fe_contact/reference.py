"""The finite-element reference: plan, certify, refine what dominates until the bars meet the tolerance."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Protocol

import numpy as np

from fe_contact.assembly.forms import check_compressible
from fe_contact.budget.certify import CAUSES, Budget, Certified, Several, certify
from fe_contact.budget.plan import SETTING, Plan, plan, refined
from fe_contact.budget.runs import operations
from fe_contact.errors import MemoryTooSmall, says_which_key
from fe_contact.progress import Progress, silent
from fe_contact.results.recovery import indentation_left, recovers
from fe_contact.results.several import whole
from fe_contact.results.told import history, quantities_of, shares_of
from fe_contact.settings import RANGES, TARGETS, Numerics
from fe_contact.steppers.chosen import struck
from fe_contact.steppers.march import Strike
from lumped.errors import BadInput, Fault, NotReached
from lumped.result.result import UNITS, Quantity, Result, meets, provenance, unmet
from lumped.scene.scene import Scene
from lumped.schema.members import get

CURE = "cure: a larger tolerance, or fewer numerics of your own"
ROUNDS = 4  # refinements before giving up
MOST_STEPS = 20_000  # of all marches of a round, about half a minute; the next one may take twice as many
MOST_OPERATIONS = 2e12  # of a round, some eighty seconds at the 2.6e10 a second that large contact problems reach
DOMINANT = 0.5  # causes above this share of the largest one, or of the tolerance, are refined together


@dataclass(frozen=True)
class Solved:
    """A certified impact with the plan it began from and the settings it ended with; CPU and wall time, s.

    ``refused``: why no finer settings were tried that may have met the tolerance; empty where none was refused.
    """

    plan: Plan
    numerics: Numerics
    certified: Certified
    cpu: float
    wall: float
    refused: str = ""


class Answer(Protocol):
    """What a result is made of, however it was found: see :class:`Solved`."""

    @property
    def plan(self) -> Plan: ...

    @property
    def numerics(self) -> Numerics: ...

    @property
    def certified(self) -> Budget: ...

    @property
    def cpu(self) -> float: ...

    @property
    def wall(self) -> float: ...

    @property
    def refused(self) -> str: ...


def fe(scene: Scene, given: Mapping[str, Any], progress: Progress = silent) -> Result:
    """Force history of a scene by finite elements, with error bars; see :func:`solve`."""
    return result_of(scene, solve(scene, given, progress))


@says_which_key
def solve(scene: Scene, given: Mapping[str, Any], progress: Progress = silent) -> Solved:
    """Plan, certify, refine until the bars meet the tolerance or nothing is left to refine.

    Parameters
    ----------
    scene : physics.
    given : checked settings that the plan must keep.
    progress : told what happens, and the steps done of those expected.

    Raises NotReached where no march came to an end, BadInput for a scene without geometry, of several impacts on a body
    that does not remember by its surface alone, or that goes deeper than its bodies.
    """
    check_target(scene)
    cpu, wall = time.process_time(), time.perf_counter()
    progress("what to expect of the contact")
    chosen = plan(scene, given)
    if scene.motion.impacts > 1 and not struck(scene.geometry, chosen.numerics).recovers:
        scene.check_single("fe, on what remembers by its bulk or by two surfaces,")
    strike = strike_of(scene)
    numerics = finer = chosen.numerics
    certified, outgrown, refused = None, None, ""
    for _ in range(ROUNDS + 1):
        try:
            certified = certify(strike, scene.geometry, finer, scene.motion.impacts, progress)
            numerics = certified.numerics
        except MemoryTooSmall as failure:
            outgrown = failure
            finer = finer.varied(contact_radius=1.5 * finer.contact_radius)
            continue
        except NotReached:
            if certified is None:
                raise
            break  # finer settings lose their way: what is known stands, with its bars
        better = refined_for(certified, numerics, chosen)
        refused = "" if better is None else _too_dear(certified, numerics, better)
        if better is None or refused:
            break
        finer = better
    if certified is None:
        raise outgrown or MemoryTooSmall(numerics.contact_radius)
    for curve in (budget.curve for budget in certified.row):
        scene.check_sunk(curve.quantities["peak_depth"] or 0.0, float(np.sqrt(curve.radius_squared.max())))
    return Solved(chosen, numerics, certified, time.process_time() - cpu, time.perf_counter() - wall, refused)


def _too_dear(certified: Certified, numerics: Numerics, finer: Numerics) -> str:
    """Why a round of finer settings is not to be afforded, from what the last one took; empty where it is.

    Steps count in proportion, and the nodes in the contact zone, which are as many as the elements, by their cube.
    """
    longer = finer.steps / numerics.steps
    steps = longer * certified.work.steps
    if steps > MOST_STEPS:
        return f"finer settings take about {steps:.0f} steps: accepted up to {MOST_STEPS}"
    wider = finer.elements_per_contact / numerics.elements_per_contact
    work = longer * wider**3 * operations(certified.work, certified.surface)
    if work > MOST_OPERATIONS:
        return f"finer settings take about {work:.2g} operations: accepted up to {MOST_OPERATIONS:.0e}"
    return ""


def check_target(scene: Scene) -> None:
    """Raise BadInput for a target which no impact is marched on, and for waves, which are marched elsewhere."""
    geometry = scene.geometry
    check_compressible(scene)
    if scene.model.inertia:
        reason = "true: this command is without waves in this version; accepted: false, or fe-contact run"
        raise BadInput(Fault(scene.source, "model.inertia", reason))
    fixed = geometry.target.fixed_radius(geometry.shape) is not None
    if not fixed and not hasattr(get(TARGETS, geometry.target.name), "struck"):
        reason = f"no impact on {geometry.target.name} by finite elements in this version; accepted: indent"
        raise BadInput(Fault(scene.source, "target.shape", reason))
    if not geometry.surface_remembers and not hasattr(get(TARGETS, geometry.target.name), "relaxing"):
        reason = f'"bulk": no impact on {geometry.target.name} with it in this version; accepted: "poisson"'
        raise BadInput(Fault(scene.source, "target.material.constant", reason))


def strike_of(scene: Scene) -> Strike:
    """What the march needs of a scene; forces in plane strain are totals, so the modulus counts with the length."""
    target, profile = scene.target, scene.profile
    place, lead = target.length_of_place, target.lead
    bent = None if place == 1.0 else lambda arc, depth: target.overlap(profile, arc / place, depth)
    return Strike(
        overlap=bent,
        height=lambda r: -target.overlap(profile, r / place, 0.0) / lead,
        mass=scene.reduced_mass,
        velocity=scene.velocity,
        gravity=scene.gravity,
        relaxation=scene.contact_modulus.scaled(scene.geometry.shape.total),
        end_time=scene.end_time,
        total=scene.geometry.shape.total,
    )


def refined_for(certified: Budget, numerics: Numerics, chosen: Plan) -> Numerics | None:
    """Settings with less of the causes that stand in the way, or None where nothing helps or is needed."""
    if all(meets(quantities_of(one), numerics.tolerance) for one in certified.row):
        return None
    excess = {cause: max(shares_of(one, cause, numerics.tolerance).max() for one in certified.row) for cause in CAUSES}
    free = {cause: value for cause, value in excess.items() if SETTING[cause] not in chosen.pinned}
    worst = max(excess.values())
    finer = numerics
    for cause, value in free.items():
        candidate = refined(finer, cause)
        if value >= DOMINANT * min(worst, 1.0) and getattr(candidate, SETTING[cause]) <= RANGES[SETTING[cause]][1]:
            finer = candidate
    return None if finer == numerics else finer


def result_of(scene: Scene, solved: Answer) -> Result:
    """The record of a certified impact, or of several."""
    first, certified = _first(scene, solved), solved.certified
    return whole(first, certified) if isinstance(certified, Several) and scene.motion.impacts > 1 else first


def _first(scene: Scene, solved: Answer) -> Result:
    """That of the first one."""
    certified, numerics = solved.certified, solved.numerics
    curve, tolerance = certified.curve, numerics.tolerance
    quantities = quantities_of(certified)
    by_quantity = {name: {cause: certified.error(name, cause) for cause in CAUSES} for name in UNITS}
    peak = quantities["peak_force"].value or np.inf
    converged = meets(quantities, tolerance)
    return Result(
        method="fe",
        converged=converged,
        separated=curve.separated,
        scene=scene,
        model=scene.model,
        tolerance=tolerance,
        history=history(certified, tolerance),
        quantities=quantities,
        numerics=numerics.as_dict(),
        error_budget={cause: value / peak for cause, value in by_quantity["peak_force"].items()},
        error_budget_by_quantity=by_quantity,
        model_ledger=solved.plan.ledger,
        energy=curve.energy,
        energy_error={name: certified.energy_error(name) for name in curve.energy if name != "residual"},
        provenance=provenance(),
        timing={"cpu_s": solved.cpu, "wall_s": solved.wall},
        work=asdict(certified.work),
        message="" if converged else "; ".join(_unmet(solved, quantities)),
        recovery=indentation_left(certified) if recovers(scene, curve) and len(certified.row) == 1 else None,
    )


def _unmet(solved: Answer, quantities: Mapping[str, Quantity]) -> list[str]:
    """What bars exceed the tolerance, what kept them from being refined, the tolerance that is met, and the cure."""
    tolerance = solved.numerics.tolerance
    shares = sum(np.nan_to_num(shares_of(solved.certified, cause, tolerance), nan=np.inf) for cause in CAUSES)
    largest = tolerance * float(np.max(shares))
    said = [unmet(quantities, tolerance), solved.refused]
    if math.isfinite(largest):
        met = 10.0 ** (math.ceil(10.0 * math.log10(largest)) / 10.0)  # rounded up
        said.append(f"a tolerance of {met:.2g} is met")
    return [part for part in said if part] + [CURE]
