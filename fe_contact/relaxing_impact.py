"""An impact with large strains on a body that relaxes: marched in time, the whole body solved in every step.

The striker goes by the velocity form of Stoermer's rule, so that its depth is known before the force is: each step is
one equilibrium at a given depth. Rule and memory are of second order in the step, which half and a quarter of the steps
show, and extrapolation takes away. The mesh stays, fine from the first contact to the widest, since points remember.

At finite strain this law of relaxation defines no free energy: what a branch stores is told by its compliance at rest.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, NamedTuple

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget import plan as statics
from fe_contact.budget.budget import CAUSES, Budget, TotalWork, shares_of
from fe_contact.budget.certify import LEAST_ORDER, other_mesh, other_setting
from fe_contact.budget.curve import Curve, extrapolated
from fe_contact.budget.plan import Plan
from fe_contact.budget.refine import Finer, dominant
from fe_contact.budget.solved import ImpactModel, record, solved
from fe_contact.budget.variation import SAFETY, Variation, factor
from fe_contact.errors import ContactLost, MemoryTooSmall, TooManySteps
from fe_contact.indentation import COARSEST
from fe_contact.large_strains import check_impact
from fe_contact.march.impact import STEPS_ALLOWED, balanced, share_of_rest, step_length, time_left
from fe_contact.progress import Count, Counted, Progress, silent, uncounted
from fe_contact.settings import DEFAULT_TOLERANCE, Given, Numerics, tolerance_of
from fe_contact.solids.base import State
from fe_contact.solids.finite import Hyperelastic
from fe_contact.solids.newton import Encounter, Equilibrium, EquilibriumLost, material_of
from fe_contact.solids.pressing import Solid, contact_radius, exhausted
from fe_contact.solids.relaxing import Fading, FadingLaw, doubled
from fe_contact.steppers.steps import March, Strike, Work
from lumped.errors import NotReached
from lumped.result.model_ledger import Peak, model_ledger
from lumped.result.result import LedgerEntry, Result, meets
from lumped.scene.geometry import Geometry
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Scene
from lumped.schema import Table
from lumped.shapes import Shape
from lumped.targets import HalfSpace, Target

ROUNDS = 3  # refinements before giving up
SECONDS = 15.0  # processor time of an impact to 1e-3, about
ELEMENTS = 3.0  # along the contact radius, at tolerance 1e-3
PENALTY = 1000.0  # stiffness of the contact
SMALLEST = 0.2  # contact over the widest one for which the mesh is made
LAST = 1e-3  # of the expected contact time: with less left the end is read off the trend
ORDER = 2  # of a step
SWING = 16.0  # of the phase of what swings on the contact, over the steps: contacts that end have smaller ones
LARGEST_SWING = 1.6  # of that phase: at 2 the rule is not stable
FEWEST = 5  # instants that tell a trend to the end


@dataclass(frozen=True, eq=False)
class Instant:
    """Striker and body at the end of a step: s, and in units of the solid depth, velocity and impulse.

    As under a rigid contact, to first order in the penalty's softness: ``displacement`` (2 N,) and the nodal forces
    ``borne`` there, (2 N,); ``memory`` of the core's points and, as displacement, of the ``rim`` and of how far the
    ``datum`` came up; ``work`` along the depth by then.
    """

    time: float
    depth: float
    velocity: float
    impulse: float
    force: float
    radius: float
    found: Equilibrium | None
    displacement: Array
    borne: Array
    memory: State
    rim: State
    datum: State = ()
    work: float = 0.0
    iterations: int = 0


@dataclass(frozen=True, eq=False)
class Marcher:
    """Takes the steps of one impact on a ``solid``; ``scale``: N per unit of force; ``power``: of a depth that a force
    is in proportion to as a contact ends.
    """

    strike: Strike
    solid: Solid
    law: FadingLaw
    numerics: Numerics
    scale: float
    power: float

    @classmethod
    def of(cls, scene: Scene, numerics: Numerics) -> Marcher:
        """On a mesh for these settings."""
        geometry, material = scene.geometry, scene.geometry.material
        indenter = Indenter(geometry.shape, material.elastic(instant=True), geometry.target, None, scene.model)
        solid = Solid.of(indenter, np.array([SMALLEST, 1.0]) * numerics.contact_radius, numerics)
        sudden = solid.encounter.body.response
        assert isinstance(sudden, Hyperelastic)
        scale = scene.contact_modulus.glassy * geometry.shape.total * solid.unit**solid.dimension
        strike = Strike.of(scene)
        return cls(strike, solid, FadingLaw.of(sudden, material), numerics, scale, strike.power)

    @property
    def body(self) -> Encounter:
        """At the moduli of a sudden strain."""
        return self.solid.encounter

    @property
    def widening(self) -> float:
        """Power of the depth that a contact is wide by, about: F ~ depth a; a flat end's hardly widens."""
        return max(self.power - 1.0, 0.0)

    def march(self, counted: Counted = uncounted) -> March:
        """From the first touch to separation, or to the end of the motion; ``counted`` is told of every step.

        Raises NotReached.
        """
        return self._record(*self._instants(counted))

    def at_peak(self) -> Equilibrium:
        """In the step in which the force peaks. Raises NotReached."""
        found = max(self._instants(uncounted)[0], key=lambda one: one.force).found
        assert found is not None  # the touch bears no force
        return found

    def _instants(self, counted: Counted) -> tuple[list[Instant], bool]:
        """The ends of all steps, and whether the contact ended."""
        instants, separated = [self._touch()], False
        while instants[-1].time < self.strike.end_time * (1.0 - 1e-12):
            here = instants[-1]
            if len(instants) > STEPS_ALLOWED * self.numerics.steps:
                raise TooManySteps(len(instants), here.time)
            left = self._time_left(instants)
            if left is not None and left < LAST * self.numerics.contact_time:
                separated = True
                break
            there = self._next(instants, left)
            if there.force <= 0.0 and there.velocity < 0.0:  # before, a first touch between the mesh's points
                if len(instants) < FEWEST:
                    raise ContactLost(here.time)
                separated = True
                break
            instants.append(there)
            counted(1.0)
        return instants, separated

    def _touch(self) -> Instant:
        core, none = self.body.body.core, Fading.over(self.law.network, 1.0)
        memory, rim = none.at_rest(4, *core.weight.shape), none.at_rest(self.body.body.rim.size)
        still, velocity = np.zeros(core.size), self.strike.velocity / self.solid.unit
        return Instant(0.0, 0.0, velocity, 0.0, 0.0, 0.0, None, still, still, memory, rim, none.at_rest())

    def _time_left(self, instants: list[Instant]) -> float | None:
        """Until the contact ends, s, while the force falls; None before."""
        if len(instants) < FEWEST or instants[-1].velocity >= 0.0:
            return None
        last = instants[-3:]
        roots = [one.force ** (1.0 / self.power) for one in last]
        return time_left([one.time for one in last], roots, last[-1].time)

    def _last_left(self, instants: list[Instant]) -> float:
        """Until a contact that has ended did, s, by the latest trend of a force that fell; 0 by none."""
        for number in range(len(instants), 0, -1):
            left = self._time_left(instants[:number])
            if left is not None:
                return max(instants[number - 1].time + left - instants[-1].time, 0.0)
        return 0.0

    def _next(self, instants: list[Instant], left: float | None) -> Instant:
        """The end of the next step: depth first, then force, then speed."""
        here, strike, numerics = instants[-1], self.strike, self.numerics
        length = numerics.contact_time * step_length(len(instants) - 1, numerics.steps, numerics.peak_share)
        if left is not None:
            length = min(length, left * share_of_rest(left / numerics.contact_time, numerics.steps))
        slowed = self.scale / (strike.mass * self.solid.unit)
        length = min(length, strike.end_time - here.time, self._steady(here, slowed))
        pull = strike.gravity / self.solid.unit
        depth = here.depth + length * (here.velocity + 0.5 * length * (pull - slowed * here.force))
        if depth <= 0.0:  # a step beyond the first touch, where nothing presses
            parted = here.velocity + length * pull - 0.5 * length * slowed * here.force
            return replace(here, time=here.time + length, depth=depth, velocity=parted, force=0.0)
        fading = Fading.over(self.law.network, length)
        found = self._equilibrium(here, depth, fading)
        force, (displacement, loaded) = found.rigid_force, found.rigid
        given = 0.5 * length * (here.force + force)
        borne = found.balance.encounter.body.forces(loaded, displacement)
        moved, datum = displacement - here.displacement, self.body.body.datum
        return Instant(
            time=here.time + length,
            depth=depth,
            velocity=here.velocity + length * pull - slowed * given,
            impulse=here.impulse + given,
            force=force,
            radius=contact_radius(found.balance) if force > 0.0 else 0.0,
            found=found,
            displacement=displacement,
            borne=borne,
            memory=loaded.answer.state,
            rim=fading.onwards(here.rim, displacement[self.body.body.rim]),
            datum=fading.onwards(here.datum, np.asarray(datum @ displacement)),
            work=here.work + 0.5 * float((here.borne + borne + (here.force + force) * datum) @ moved),
            iterations=here.iterations + found.iterations,
        )

    def _steady(self, here: Instant, slowed: float) -> float:
        """Length of a step, s, in which a striker that its weight holds down swings by little: the rule is explicit."""
        if here.found is None or here.found.stiffness <= 0.0:
            return np.inf
        return min(SWING / self.numerics.steps, LARGEST_SWING) / math.sqrt(slowed * here.found.stiffness)

    def _equilibrium(self, here: Instant, depth: float, fading: Fading) -> Equilibrium:
        """At a depth after what is remembered. Raises EquilibriumLost."""
        body, penalty = self.body.body, self.numerics.penalty * self.solid.unit / self.numerics.contact_radius
        relaxing = replace(
            body,
            response=self.law.over(fading),
            rest=fading.at_once * body.rest,
            pull=body.rest @ fading.held(here.rim),
        )
        solid = replace(self.solid, encounter=replace(self.body, body=relaxing))
        reach = solid.unit * depth
        try:
            return solid.advanced(here.found, reach, penalty, self.widening, here.memory)
        except EquilibriumLost as lost:
            if here.found is None:
                raise
            try:  # pressed in softly instead
                start = here.found.balance.displacement
                return solid.advanced(None, reach, penalty, self.widening, here.memory, start)
            except EquilibriumLost:
                raise lost from None

    def _record(self, instants: list[Instant], separated: bool) -> March:
        """What the march leaves behind; after its last step the contact ends as the trend says."""
        unit, strike, last = self.solid.unit, self.strike, instants[-1]
        rows = [(one.time, unit * one.depth, self.scale * one.impulse) for one in instants]
        speed = unit * last.velocity
        left = self._last_left(instants) if separated else 0.0
        if left > 0.0:
            impulse = self.scale * last.force * left / (self.power + 1.0)
            slowed = impulse / strike.mass * (self.power + 1.0) / (self.power + 2.0)
            fallen = 0.5 * strike.gravity * left - slowed
            rows.append((last.time + left, rows[-1][1] + left * (speed + fallen), rows[-1][2] + impulse))
            speed += strike.gravity * left - impulse / strike.mass
        time, depth, given = np.array(rows).T
        return March(
            time=time,
            depth=depth,
            impulse=given,
            first_force=0.0,
            radius_time=time[1 : len(instants)],
            radius=unit * np.array([one.radius for one in instants[1:]]),
            separated=separated,
            photograph=tuple,
            energy=self._account(instants, float(depth[-1]), speed),
            end_spread=0.0,
            work=Work(len(instants) - 1, len(instants) - 1, last.iterations),
        )

    def _account(self, instants: list[Instant], depth: float, speed: float) -> dict[str, float]:
        """Terms in J; the penalty holds nothing in the end."""
        strike, joule, last = self.strike, self.scale * self.solid.unit / self.solid.lead, instants[-1]
        found = last.found
        assert found is not None  # no impact ends where it begins
        brought = 0.5 * strike.mass * strike.velocity**2 + strike.mass * strike.gravity * depth
        stored = joule * (self._stored(last) - self._stored_below(instants))
        none = dict.fromkeys(("radiated", "numerical"), 0.0)
        out = 0.5 * strike.mass * speed**2
        known = {"in": brought, "out": out, "stored": stored, "viscous": joule * last.work - stored}
        return balanced({**known, "contact": joule * found.balance.touch.energy, **none})

    def _stored(self, last: Instant) -> float:
        """By what lasts and by every branch in the end."""
        body, law, displacement = self.body.body, self.law, last.displacement
        rim, shares = displacement[body.rim], np.array(law.network.moduli) / law.network.glassy
        lasting, nu = law.network.relaxed / law.network.glassy, law.branches_nu
        found = body.core.answered(displacement, law.lasting).energy + float(0.5 * lasting * rim @ body.rest @ rim)
        for share, stress, moved in zip(shares, last.memory[1], last.rim[1], strict=True):
            trace = stress[0] + stress[1] + stress[2]
            square = doubled(stress, stress) - nu / (1.0 + nu) * trace**2
            points = float(np.vdot(body.core.weight, square)) / (4.0 * law.sudden.shear)
            found += float(points + 0.5 * moved @ body.rest @ moved) / share
        return found

    def _stored_below(self, instants: list[Instant]) -> float:
        """What a datum's way up holds of that: it goes, as the network does, with the force alone, and as much work of
        it as was done up to the peak.
        """
        if not self.body.follows:
            return 0.0
        network = self.law.network
        lasting, shares = network.relaxed / network.glassy, np.array(network.moduli) / network.glassy
        force = np.array([one.force for one in instants])
        way = np.array([float(one.datum[0]) for one in instants])
        answer = np.array([float(lasting * one.datum[0] + one.datum[1].sum()) for one in instants])
        loading = slice(int(force.argmax()) + 1)
        stiffness = -np.trapezoid(force[loading], way[loading]) / np.trapezoid(answer[loading], way[loading])
        _, branches = instants[-1].datum
        return float(0.5 * stiffness * (lasting * way[-1] ** 2 + (branches**2 / shares).sum()))


def at_peak(scene: Scene, result: Result) -> tuple[Solid, Equilibrium]:
    """The body of a result with its settings, in the step in which the force peaks. Raises NotReached."""
    with material_of(scene):
        marcher = Marcher.of(scene, Numerics(**result.numerics))
        return marcher.solid, marcher.at_peak()


def _throughout(change: Variation) -> Variation:
    """Of the duration at least the share that it changes of the peak force: a body that errs alike everywhere, whose
    force goes as a power of the depth, changes both by one share. Two coarse meshes may agree in one by chance.
    """
    first, errors = change.first.quantities, change.errors
    peak, duration = first["peak_force"], first["duration"]
    if not peak or not duration or not errors["duration"]:
        return change
    share = errors["peak_force"] / peak / (errors["duration"] / duration)
    return replace(change, weights={"duration": max(1.0, share)})


def plan(scene: Scene, given: Given) -> Plan:
    """Settings and ledger; scales are those of small strains. Raises NotReached."""
    check_impact(scene, given)
    known, numerics, shape = statics.plan(scene, {}), settings(given), scene.geometry.shape
    # contacts end beside the rim of a flat end that is rounded off: a mesh for wider ones is coarse there
    if shape.flat_radius and scene.geometry.target.fixed_radius(shape) is None:
        (contact,) = expected_contacts(scene, (shape,))
        numerics["contact_radius"] = contact.contact_radius
    return Plan(known.numerics.varied(**numerics), frozenset(given) - {"tolerance"}, known.ledger)


def settings(given: Given) -> Table:
    """Those that small strains choose otherwise, and those that are given."""
    tolerance = tolerance_of(given)
    elements = max(COARSEST, ELEMENTS * (DEFAULT_TOLERANCE / tolerance) ** 0.5)
    return {"tolerance": tolerance, "elements_per_contact": elements, "penalty": PENALTY, **given}


class ExpectedContact(NamedTuple):
    """Force over modulus, m^2, and contact radius, m."""

    force: float
    contact_radius: float


def expected_contacts(scene: Scene, faces: Sequence[Shape]) -> list[ExpectedContact]:
    """Under these faces, at the depth that small strains have under the scene's own. Raises NotReached.

    Where contacts grow wider than a layer's curve serves, as on a half-space that presses back as hard.
    """
    depth, geometry = statics.expected(scene).peak_depth, scene.geometry
    try:
        return _pressed(faces, geometry, geometry.target, depth)
    except NotReached:
        force, soft = (one.load_curve(geometry.shape, geometry.material.nu) for one in (geometry.target, HalfSpace()))
        return _pressed(faces, geometry, HalfSpace(), depth * float(force.force(depth) / soft.force(depth)))


def _pressed(faces: Sequence[Shape], geometry: Geometry, target: Target, depth: float) -> list[ExpectedContact]:
    curves = [target.load_curve(face, geometry.material.nu) for face in faces]
    return [ExpectedContact(float(curve.force(depth)), float(curve.contact_radius(depth))) for curve in curves]


@dataclass(frozen=True)
class RelaxingStrikes:
    """The way of an impact with large strains on what relaxes."""

    scene: Scene
    chosen: Plan
    progress: Progress
    rounds: ClassVar[int] = ROUNDS

    def certified(self, numerics: Numerics) -> Budget:
        """The contact and its bars: steps on the finest mesh, all else with half of them. Raises NotReached."""
        half, solid = numerics.varied(steps=numerics.steps // 2), Marcher.of(self.scene, numerics).solid
        mesh, by_mesh = other_mesh(half, solid.mesh_order)
        softer, stiff = other_setting(half, "penalty")
        nearer, far = other_setting(mesh, "far_radius")
        settings = (numerics, half, numerics.varied(steps=numerics.steps // 4), mesh, softer, nearer)
        runs = [self._run(one) for one in settings]
        fine, middle, coarse, meshed, soft, near = (Curve.of(run, Strike.of(self.scene)) for run in runs)
        value, before = extrapolated(fine, middle, ORDER), extrapolated(middle, coarse, ORDER)
        value = value.with_peak_spread()
        changes = {
            "mesh": (_throughout(Variation(middle, meshed, by_mesh)),),
            "penalty": (Variation(middle, soft, factor(LEAST_ORDER["penalty"], stiff)),),
            "time_step": (Variation(value, before, SAFETY / (2**ORDER - 1)),),
            "far_field": (Variation(meshed, near, factor(LEAST_ORDER["far_field"], far)),),
        }
        works = [run.work for run in runs]
        iterations = sum(one.iterations for one in works)
        total = TotalWork.of(works, solid.unknowns, iterations, iterations)
        return Budget(value, runs[0], changes, total, numerics)

    def _run(self, numerics: Numerics) -> March:
        message = f"{numerics.elements_per_contact:.3g} elements along the contact radius, {numerics.steps} steps"
        with material_of(self.scene):
            march = Marcher.of(self.scene, numerics).march(Count.of(self.progress, message, numerics.steps))
        if not np.all(np.isfinite(march.radius)):
            raise MemoryTooSmall(numerics.contact_radius)
        return march

    def finer(self, found: Budget) -> Finer:
        """Less of the causes that stand in the way."""
        if meets(found.quantities, found.numerics.tolerance):
            return Finer(None)
        excess = {cause: float(shares_of(found, cause).max()) for cause in CAUSES}
        order = Marcher.of(self.scene, found.numerics).solid.mesh_order
        kept = self.chosen.pinned | exhausted(order, found.numerics)
        return Finer(dominant(excess, found.numerics, kept, least=1.0))

    def ledger(self, found: Budget) -> tuple[LedgerEntry, ...]:
        """What the model leaves out of the impact that was found."""
        return model_ledger(self.scene, Peak.of(found.quantities, found.history()))


def expected(scene: Scene, given: Given) -> tuple[float, float]:
    """Tolerance, and processor time, s, about. Raises BadInput."""
    check_impact(scene, given)
    return tolerance_of(given), SECONDS


def fe(scene: Scene, given: Given, progress: Progress = silent) -> Result:
    """Force history and error bars. Raises NotReached where an equilibrium is lost."""
    found = solved(scene, given, progress, plan, RelaxingStrikes)
    return record(scene, found)


RELAXING = ImpactModel(check_impact, plan, expected, fe)
