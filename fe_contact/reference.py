"""The finite-element reference: plan, certify, refine what dominates until the bars meet the tolerance.

After separation: the indentation left on the axis of a half-space, and how the surface recovers.

The axis touches the striker from first to last, so its displacement in the contact is the striker's depth, and the
strain y_k of each of its dashpots follows from that alone: y_k' = (depth - y_k)/tau_k. From the separation on nothing
presses; see :class:`lumped.materials.Recovery`. All is linear in the path, and so are the bars: what a varied setting
changes is followed through the recovery.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from fe_contact.assembly.forms import Array, check_compressible
from fe_contact.budget import plan as statics
from fe_contact.budget.budget import CAUSES, Budget, shares_of
from fe_contact.budget.certify import Certified, certify
from fe_contact.budget.curve import Curve
from fe_contact.budget.plan import Plan
from fe_contact.budget.refine import Finer, dominant
from fe_contact.budget.runs import operations
from fe_contact.budget.solved import ImpactModel, SolvedBy, dent_left, record, solved
from fe_contact.budget.variation import Softening, Variation
from fe_contact.errors import faults_of
from fe_contact.progress import Progress, silent
from fe_contact.schemes import galerkin
from fe_contact.settings import DEFAULT_TOLERANCE, Given, Numerics, WaveNumerics, check_kind, tolerance_of
from fe_contact.steppers.steps import Strike
from fe_contact.targets.base import TARGETS, recovers_in_flight, seconds_of_impact
from lumped.errors import BadInput, Fault
from lumped.materials import Recovery
from lumped.result.result import IndentationLeft, LedgerEntry, Result, meets
from lumped.scene.scene import Scene
from lumped.shapes._block import Block
from lumped.targets import HalfSpace

if TYPE_CHECKING:
    from fe_contact.solids.newton import Equilibrium
    from fe_contact.solids.pressing import Solid
    from fe_contact.waves.targets.base import WaveTarget

ROUNDS = 4  # refinements before giving up
MOST_STEPS = 20_000  # of all marches of a round, about half a minute; the next one may take twice as many
MOST_OPERATIONS = 3e12  # of a round, two minutes: contact problems reach 2e10 to 4e10 a second

SHARES = np.linspace(0.0, 1.0, 2001) ** 2  # of the contact: straight between them its path errs by 1e-7 of its depth
ROWS = 25  # look: of the recovery, zero among them
FIRST_GONE, LAST_LEFT = 0.99, 0.01  # of what goes, left at the first and at the last row after separation

Solved = SolvedBy[Certified]  # without waves


def fe(scene: Scene, given: Given, progress: Progress = silent) -> Result:
    """Force history of a scene by finite elements and error bars, whatever its model; see :func:`solve`."""
    with faults_of(scene):
        model = model_of(scene)
        model.check(scene, given)
        return model.fe(scene, given, progress)


def answered(scene: Scene, given: Given, progress: Progress = silent) -> tuple[Result, Solved | None]:
    """The same, and the certified march behind it, with its pressures; None where statics are not all."""
    if model_of(scene) is not STATICS:
        return fe(scene, given, progress), None
    found = solve(scene, given, progress)
    return result_of(scene, found), found


def plan(scene: Scene, given: Given) -> Plan:
    """Choose what ``given`` (checked settings, see :func:`fe_contact.settings.checked`) leaves open.

    Raises NotReached where even a coarse estimate does not come to an end.
    """
    with faults_of(scene):
        return model_of(scene).plan(scene, given)


def expected(scene: Scene, given: Given) -> tuple[float, float]:
    """Tolerance, and processor time, s, about, of :func:`fe` once packages are loaded. Raises NotReached, BadInput."""
    with faults_of(scene):
        return model_of(scene).expected(scene, given)


def check(scene: Scene, given: Given) -> None:
    """Raise BadInput for an impact that finite elements do not answer."""
    model_of(scene).check(scene, given)


def model_of(scene: Scene) -> ImpactModel:
    """What answers a scene, by its model. Loaded when it is asked: most scenes are without waves, strained little."""
    if scene.model.plasticity and not scene.model.inertia:
        from fe_contact.plastic.impact import YIELDING

        return YIELDING
    if scene.model.finite:
        from fe_contact.large_strains import ELASTIC
        from fe_contact.relaxing_impact import RELAXING
        from fe_contact.relaxing_punch import PUNCHED

        if scene.geometry.material.young.is_elastic:
            return ELASTIC
        return PUNCHED if scene.geometry.sharp_rim else RELAXING
    return _of_waves(with_waves(scene)) if scene.model.inertia else STATICS


def strained_at_peak(result: Result) -> tuple[Solid, Equilibrium]:
    """The body of a result of large strains where the force peaks, with its settings. Raises NotReached."""
    from fe_contact import large_strains, relaxing_impact  # late: few impacts need them

    if result.scene.geometry.material.young.is_elastic:
        return large_strains.at_peak(result.scene, result)
    return relaxing_impact.at_peak(result.scene, result)


def with_waves(scene: Scene) -> WaveTarget:
    """What strikes or is struck with inertia. Raises BadInput."""
    from fe_contact.waves.targets.base import WAVES  # late: few impacts need it

    return WAVES.get(scene.target.name)


def _of_waves(target: WaveTarget) -> ImpactModel:
    """What answers impacts on it, or of it."""

    def check(scene: Scene, given: Given) -> None:
        check_kind(given, True, scene.source)
        target.check(scene)

    def plan(scene: Scene, given: Given) -> Plan:
        check(scene, given)
        return target.plan(scene, given)

    def expected(scene: Scene, given: Given) -> tuple[float, float]:
        chosen = plan(scene, given).numerics
        assert isinstance(chosen, WaveNumerics)
        return chosen.tolerance, target.cost(scene, chosen).seconds

    def fe(scene: Scene, given: Given, progress: Progress) -> Result:
        found = solved(scene, given, progress, plan, target.way)
        return record(scene, found, dent_left(found.certified))

    return ImpactModel(check, plan, expected, fe)


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
        return solved(scene, given, progress, statics.plan, Statics)


def result_of(scene: Scene, found: Solved) -> Result:
    """The record of what :func:`solve` found, and of the indentation left where one impact leaves one that is known."""
    certified = found.certified
    left = len(certified.row) == 1 and recovers(scene, certified.curve)
    return record(scene, found, indentation_left(certified) if left else None)


@dataclass(frozen=True, eq=False)
class Statics:
    """The way without waves: every round a budget of its own."""

    scene: Scene
    chosen: Plan
    progress: Progress
    rounds: ClassVar[int] = ROUNDS

    def certified(self, numerics: Numerics) -> Certified:
        """A contact, or several, and the bars. Raises BadInput for one deeper than its bodies."""
        scene = self.scene
        fixed = "steps" in self.chosen.pinned
        found = certify(Strike.of(scene), scene.geometry, numerics, scene.motion.impacts, self.progress, fixed)
        for curve in (budget.curve for budget in found.row):
            scene.check_sunk(curve.quantities["peak_depth"] or 0.0, float(np.sqrt(curve.radius_squared.max())))
        return found

    def finer(self, found: Certified) -> Finer:
        """Less of the causes that stand in the way, unless that is not to be afforded."""
        tolerance = found.numerics.tolerance
        if all(meets(part, tolerance) for part in found.parts):
            return Finer(None)
        excess = {cause: max(shares_of(one, cause).max() for one in found.row) for cause in CAUSES}
        settings = dominant(excess, found.numerics, self.chosen.pinned, least=1.0)
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
    bulky = TARGETS.get(geometry.target.name).relaxing is not None and not isinstance(geometry.shape, Block)
    if not (geometry.surface_remembers or bulky):
        pair = f"of {geometry.shape.name} on {geometry.target.name}"
        reason = f'"bulk": no impact {pair} with it in this version; accepted: "poisson"'
        raise BadInput(Fault(scene.source, f"{part}.material.constant", reason) for part in geometry.changing)
    if not recovers_in_flight(geometry):
        scene.check_single("fe, on what remembers by its bulk or by two surfaces,")


def _expected(scene: Scene, given: Given) -> tuple[float, float]:
    """Without waves: in proportion to how much tighter than the default the tolerance is."""
    check_target(scene)
    tolerance = tolerance_of(given)
    tighter = max(DEFAULT_TOLERANCE / tolerance, 1.0)
    return tolerance, scene.motion.impacts * tighter * seconds_of_impact(scene.geometry)


STATICS = ImpactModel(
    lambda scene, _: check_target(scene),
    statics.plan,
    _expected,
    lambda scene, given, progress: result_of(scene, solve(scene, given, progress)),
)


def recovers(scene: Scene, curve: Curve) -> bool:
    """Whether the indentation left is known: a half-space that remembers, without waves, from a rigid striker."""
    geometry = scene.geometry
    lone = isinstance(geometry.target, HalfSpace) and not geometry.shape.plane and scene.striker_material is None
    return lone and curve.separated and not scene.model.inertia and not curve.strike.relaxation.is_elastic


def indentation_left(certified: Budget) -> IndentationLeft:
    """Rows from separation to the time when a hundredth of what goes is left, with bars."""
    curve, axes = certified.curve, dict[int, _Axis]()
    axis = _Axis(curve)
    recovery = axis.after(axis.path)
    time = _rows_of(recovery)
    errors = [_error_left(change, time, axes) for changes in certified.changes.values() for change in changes]
    reading = axis.left_at_most(_everywhere(curve.end_spread * curve.leaving_speed), time)
    total = np.sum([reading, *errors], axis=0)
    return IndentationLeft(time, recovery(time), total, recovery.permanent, recovery.times)


@dataclass(frozen=True, eq=False)
class _Axis:
    """The axis in the contact of a curve: its path, and what paths over the same times leave."""

    curve: Curve

    @cached_property
    def time(self) -> Array:
        """Times of the contact at which paths are read, s, (n,)."""
        return np.asarray(self.curve.duration * SHARES)

    @cached_property
    def path(self) -> Array:
        """Its own, m, (n,)."""
        return self.curve.read(self.time).depth

    @cached_property
    def _taken(self) -> Array:
        """Share of each rise that a dashpot has taken over by the end: by its own step, by all after it; (k, n-1)."""
        steps, taus = np.diff(self.time), np.array(self.curve.strike.relaxation.times)[:, None]
        ramp, fade = galerkin.weights(np.ones(1), steps / taus)
        return np.asarray(ramp * steps / taus - fade * np.expm1((self.time[1:] - self.time[-1]) / taus))

    def after(self, path: Array) -> Recovery:
        """What a path, m, (n,), leaves: straight between the times, zero at first."""
        return Recovery.of(self.curve.strike.relaxation, float(path[-1]), self._taken @ np.diff(path))

    def left_at_most(self, path: Array, time: Array) -> Array:
        """The most that is left of an error of the path from each time since separation on, (m,), m."""
        return _from_each_on(self.after(path)(time))


def _rows_of(recovery: Recovery) -> Array:
    """Zero, then times in equal ratios; zero alone where nothing goes."""
    last = recovery.until(LAST_LEFT)
    return np.concatenate([[0.0], np.geomspace(recovery.until(FIRST_GONE), last, ROWS - 1)] if last else [[0.0]])


def _error_left(change: Variation | Softening | None, time: Array, axes: dict[int, _Axis]) -> Array:
    """Error by one change at times since separation (n,), s, m; ``axes`` by their curves, most of which serve often.

    Of two recoveries the difference may be none by chance, what the path's change leaves with its sign taken away not.
    """
    if change is None:
        return np.full_like(time, np.inf)
    if isinstance(change, Softening):
        return _Axis(change.curve).left_at_most(_everywhere(change.errors["peak_depth"]), time)
    first, second = (axes.setdefault(id(curve), _Axis(curve)) for curve in (change.first, change.second))
    apart = _from_each_on(first.after(first.path)(time) - second.after(second.path)(time))
    trust = change.factor * max(change.weights.values(), default=1.0)
    return np.asarray(trust * np.maximum(apart, first.left_at_most(np.abs(first.path - second.path), time)))


def _from_each_on(values: Array) -> Array:
    """The largest size from each value on."""
    return np.asarray(np.maximum.accumulate(np.abs(values)[::-1])[::-1])


def _everywhere(error: float) -> Array:
    """An error of the path, m, the same all along it."""
    return np.where(SHARES > 0.0, error, 0.0)
