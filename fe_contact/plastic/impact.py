"""An impact on a half-space that yields: without inertia of its own it knows depths alone, and no time.

The force is one function of the depth until the striker's energy is spent, another one from there on. Work and time are
their integrals; every setting is varied once, and each of these runs has a greatest depth of its own. There the force
peaks and its second derivative jumps, which no polynomial through both sides would tell.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar, NamedTuple

import numpy as np

from fe_contact.assembly.cache import cached
from fe_contact.assembly.forms import Array
from fe_contact.budget.budget import CAUSES, Budget, TotalWork, shares_of
from fe_contact.budget.curve import Curve
from fe_contact.budget.plan import Plan
from fe_contact.budget.refine import Finer
from fe_contact.budget.solved import ImpactModel, dent_left, record, solved
from fe_contact.budget.variation import SAFETY, Variation
from fe_contact.errors import MemoryTooSmall
from fe_contact.march.impact import balanced
from fe_contact.plastic.course import (
    BEYOND,
    Contrast,
    Course,
    PlasticLoading,
    Varied,
    check_given,
    columns,
    finer,
    overlapping,
    settings,
    within_core,
)
from fe_contact.plastic.indent import ROUNDS
from fe_contact.plastic.path import Station, parting
from fe_contact.progress import Progress, silent
from fe_contact.settings import Given, Numerics, check_kind, tolerance_of
from fe_contact.steppers.steps import March, Strike, Work
from lumped.errors import BadInput, Fault, NotReached
from lumped.progress import step_done
from lumped.result.model_ledger import Peak, model_ledger
from lumped.result.result import LedgerEntry, Result, meets
from lumped.scene.scene import Scene

# Processor time, s, of an impact at so loose a tolerance, about, and the power that it follows a tighter one with.
SECONDS, SO_LOOSE, TIGHTER = 8.0, 5e-3, 0.45
ROWS = 400  # of each half of an impact: the line between two errs by 1e-5 of the force
GRID = 500  # depths at which a loading is told
SPRUNG = np.linspace(0.0, 1.0, 101)  # shares of what springs back, from parting on
DEGREE = 5  # of the polynomial through the forces of a release, to the power that makes them a line
RELEASES = 16  # steps of a release: it errs by where edges cross elements, alike whatever the steps of the loading were
# Of the run that tells how deep an impact will go: a soft penalty settles soon where a body flows from the touch on.
PILOT: Given = {"elements_per_contact": 2.0, "steps": 16, "penalty": 4000.0}
PILOT_FIRST = 0.01  # of its depth, its first step: the work up to there is 1e-4 of the whole
MOST_PILOT = 1500  # work: its guesses; 280 where a body begins to yield, 640 where it flows from the touch on
SOFTEST = 0.75  # of the yield strength, on what overlaps: hardly a lower force while a body yields


class HeldDown(NotReached):
    """What springs back does not lift the striker."""

    def __init__(self, depth: float) -> None:
        reason = f"the weight holds the striker, which went {depth:.3g} m deep"
        super().__init__(reason, "a higher striker.velocity, or model.gravity = 0")


@dataclass(frozen=True, eq=False)
class Answered:
    """What a body answers: ln of the force, N, and contact radius, m, at depths (n,), m; of a release from the greatest
    depth the share of it that ``springs`` back, force^(1/power) and contact radius over their own there at ``SPRUNG``;
    energy ``stored`` and ``plastic`` work in the end, J; ``misfit`` (n,): of the smooth logarithm.
    """

    depth: Array
    logarithm: Array
    radius: Array
    springs: float
    roots: Array
    shrunk: Array
    stored: float
    plastic: float
    misfit: Array

    @classmethod
    def of(cls, loading: PlasticLoading) -> Answered:
        """Of a loading; its release is not known yet."""
        course, pressed = loading.course, loading.pressed
        depth = np.geomspace(course.first, BEYOND * course.deepest, GRID)
        return cls(
            depth=depth,
            logarithm=pressed.logarithm(depth),
            radius=pressed.contact_radius(depth),
            springs=1.0,
            roots=SPRUNG,
            shrunk=SPRUNG,
            stored=0.0,
            plastic=0.0,
            misfit=pressed.misfit(depth),
        )


def _onwards(one: Answered, fine: Answered, coarse: Answered, weight: float) -> Answered:
    """``one`` and ``weight`` times what ``fine`` changes of ``coarse``; the depths of all are the same."""

    def of(name: str) -> Array:
        found: Array = getattr(one, name) + weight * (getattr(fine, name) - getattr(coarse, name))
        return found

    return replace(
        one,
        logarithm=of("logarithm"),
        roots=of("roots"),
        springs=float(of("springs")),
        stored=float(of("stored")),
        plastic=float(of("plastic")),
    )


def misfit(mended: Answered, told: Varied[Answered]) -> Contrast[Answered]:
    """What ``mended`` may miss between its knots: all meshes miss it alike, and the median has the least noise."""
    missed = np.median([one.misfit for one in told.meshes], axis=0)
    return Contrast(mended, replace(mended, logarithm=mended.logarithm + missed), SAFETY)


@dataclass(frozen=True, eq=False)
class Rebound:
    """A striker of ``mass``, kg, ``energy``, J, and ``weight``, N, on a body that answers so.

    Its force ~ depth^``start`` before the first depth known, and (what is left)^``power`` in the end.
    """

    answered: Answered
    mass: float
    energy: float
    power: float
    start: float
    weight: float = 0.0

    @classmethod
    def of(cls, answered: Answered, scene: Scene, course: Course) -> Rebound:
        """The striker of a scene, on what answers to its course."""
        mass = scene.reduced_mass
        return cls(answered, mass, _energy(scene), released_power(course), course.power, mass * scene.gravity)

    def force(self, depth: Array) -> Array:
        """While it comes in, N; below the first depth known a power of the depth."""
        known = self.answered
        inside = np.log(np.clip(depth, known.depth[0], known.depth[-1]))
        before = np.minimum(np.log(np.maximum(depth, 1e-300) / known.depth[0]), 0.0)
        return np.asarray(np.exp(np.interp(inside, np.log(known.depth), known.logarithm) + self.start * before))

    def work(self) -> tuple[Array, Array]:
        """Depths, m, and the work up to them, J, less that of the weight."""
        depth = np.concatenate([[0.0], self.answered.depth])
        between = 0.5 * (depth[1:] + depth[:-1])
        thirds = (self.force(depth[:-1]) + 4.0 * self.force(between) + self.force(depth[1:])) * np.diff(depth) / 6.0
        thirds[0] = self.force(depth[1:2])[0] * depth[1] / (self.start + 1.0)
        return depth, np.concatenate([[0.0], np.cumsum(thirds)]) - self.weight * depth

    @property
    def deepest(self) -> float:
        """Where the energy is spent, m; infinite where that is deeper than is known."""
        depth, work = self.work()
        if work[-1] <= self.energy:
            return float("inf")
        after = int(np.argmax(work > self.energy))
        low, high = float(depth[after - 1]), float(depth[after])
        for _ in range(50):
            middle = 0.5 * (low + high)
            mean = (
                self.force(np.array([depth[after - 1], 0.5 * (depth[after - 1] + middle), middle])) @ [1, 4, 1]
            ) / 6.0
            spent = work[after - 1] + (mean - self.weight) * (middle - depth[after - 1])
            low, high = (middle, high) if spent < self.energy else (low, middle)
        return high

    def march(self, work: Work) -> March:
        """Rows of the whole contact. Raises HeldDown."""
        deepest, known = self.deepest, self.answered
        share = np.linspace(0.0, 1.0, ROWS + 1)
        coming = deepest * (1.0 - (1.0 - share) ** 2)  # from the greatest depth as the square of the time left
        here = self.force(coming)
        inward = _fallen(deepest, here[::-1] - self.weight, self.mass)
        sprung = known.springs * deepest
        top = float(here[-1])
        going = deepest - sprung * share**2
        left = 1.0 - share**2
        back = top * np.maximum(np.interp(left, SPRUNG, known.roots), 0.0) ** self.power
        outward = _fallen(sprung, back - self.weight, self.mass)
        if not np.all(outward.speed[1:] > 0.0):
            raise HeldDown(deepest)
        time = np.concatenate([inward.time[-1] - inward.time[::-1], inward.time[-1] + outward.time[1:]])
        speed = np.sqrt(2.0 * self.energy / self.mass)
        velocity = np.concatenate([inward.speed[::-1], -outward.speed[1:]])
        radius_in = np.exp(np.interp(np.log(np.maximum(coming, 1e-300)), np.log(known.depth), np.log(known.radius)))
        faint = coming < known.depth[0]
        radius_in[faint] = known.radius[0] * (coming[faint] / known.depth[0]) ** (self.start - 1.0)
        radius = np.concatenate([radius_in, radius_in[-1] * np.interp(left, SPRUNG, known.shrunk)[1:]])
        return March(
            time=time,
            depth=np.concatenate([coming, going[1:]]),
            impulse=self.mass * (speed - velocity) + self.weight * time,
            first_force=0.0,
            radius_time=time[1:-1],
            radius=radius[1:-1],
            separated=True,
            photograph=tuple,
            energy=self._account(deepest - sprung, float(outward.speed[-1])),
            end_spread=0.0,
            work=work,
            dent=float(going[-1]),
        )

    def _account(self, left: float, speed: float) -> dict[str, float]:
        """Of a striker that leaves an indentation ``left`` deep, m, at a ``speed``, m/s."""
        none = dict.fromkeys(("viscous", "radiated", "contact", "numerical"), 0.0)
        own = {name: getattr(self.answered, name) for name in ("stored", "plastic")}
        return balanced({"in": self.energy + self.weight * left, "out": 0.5 * self.mass * speed**2, **own, **none})


@dataclass(frozen=True, eq=False)
class Fallen:
    """A mass driven from rest: ``time``, s, and ``speed``, m/s, at equal steps of the root of its way."""

    time: Array
    speed: Array


def _fallen(way: float, force: Array, mass: float) -> Fallen:
    """Over a ``way``, m, by forces (n,), N, at ``way`` x^2, x from 0 to 1 in equal steps.

    Its speed is in proportion to x but for a smooth factor, so that time is smooth in x.
    """
    x = np.linspace(0.0, 1.0, force.size)
    step = 1.0 / (force.size - 1)
    driven = np.concatenate([[0.0], np.cumsum(_simpson(2.0 * way * force * x, step))])
    with np.errstate(invalid="ignore", divide="ignore"):
        factor = np.sqrt(2.0 * driven / mass) / x
    factor[0] = np.sqrt(2.0 * force[0] * way / mass)
    slowness = 2.0 * way / factor
    return Fallen(np.concatenate([[0.0], np.cumsum(_simpson(slowness, step))]), factor * x)


def _simpson(values: Array, step: float) -> Array:
    """Integral over every step of values (n,) by the cubics through the nearest four, (n - 1,)."""
    inner = (13.0 * (values[1:-2] + values[2:-1]) - values[:-3] - values[3:]) / 24.0
    first = (9.0 * values[0] + 19.0 * values[1] - 5.0 * values[2] + values[3]) / 24.0
    last = (9.0 * values[-1] + 19.0 * values[-2] - 5.0 * values[-3] + values[-4]) / 24.0
    return step * np.concatenate([[first], inner, [last]])


def let_go(loading: PlasticLoading, deepest: float, power: float) -> list[Station]:
    """Places of a release from the greatest depth of an impact, m, that one first."""
    presser, depth = loading.presser, deepest / loading.course.unit
    last = [place.depth < depth * (1.0 - 1e-6) for place in loading.ends].index(False) - 1
    before, here = loading.ends[max(last - 1, 0)], loading.ends[last]
    taken = list(presser.loaded(before, here, depth))
    return presser.released(taken[-1], RELEASES, power)


def answered(loading: PlasticLoading, known: Answered, places: list[Station], power: float) -> Answered:
    """What is ``known`` of a loading, and a release by its places."""
    course, presser = loading.course, loading.presser
    springs, roots, shrunk = _release(places, power)
    final, unit = places[-1], course.modulus * course.unit**3
    return replace(
        known,
        springs=springs,
        roots=roots,
        shrunk=np.ones_like(shrunk) if course.rim else shrunk,
        stored=unit * final.scale**3 * presser.ground.stored(final.displacement, final.state),
        plastic=unit * final.worked,
    )


def _release(places: list[Station], power: float) -> tuple[float, Array, Array]:
    """Share of the depth that springs back; force^(1/power) and contact radius at ``SPRUNG``, over those at first."""
    depth, force, radius = columns(places)
    top = depth[0]
    fit = np.polynomial.Polynomial.fit(depth, (force / force[0]) ** (1.0 / power), min(DEGREE, depth.size - 2))
    end = parting(places[-2], places[-1], power)
    for _ in range(20):
        end -= fit(end) / fit.deriv()(end)
    roots = fit(end + SPRUNG * (top - end))
    left = (depth[::-1] - end) / (top - end)
    shrunk = np.interp(SPRUNG, np.concatenate([[0.0], left]), np.concatenate([[0.0], radius[::-1] / radius[0]]))
    return float((top - end) / top), roots / roots[-1], shrunk


def released_power(course: Course) -> float:
    """Of what is left to spring back, that the force of a release ends with: dents are round, rims stay."""
    return 1.0 if course.rim else 1.5


class Pilot(NamedTuple):
    """How an impact will go, about: its course to the greatest depth, and its march. It enters no value."""

    course: Course
    march: March


@cached
def pilot(scene: Scene) -> Pilot:
    """By a coarse mesh and few steps. Raises NotReached."""
    deepest = _at_most(scene, _energy(scene))
    course = Course.of(scene, deepest, deepest).starting_at(PILOT_FIRST * deepest)
    return within_core(course, partial(_piloted, scene))


def _piloted(scene: Scene, course: Course) -> Pilot:
    loading = PlasticLoading.of(course, settings(PILOT, course), most=MOST_PILOT, counted=step_done)
    loading.to(BEYOND * course.deepest)
    found = Rebound.of(Answered.of(loading), scene, course)
    deepest = found.deepest
    return Pilot(replace(Course.of(scene, deepest, deepest), core=course.core), found.march(Work()))


def _energy(scene: Scene) -> float:
    """Of the striker at touch, J."""
    return 0.5 * scene.reduced_mass * scene.velocity**2


def _at_most(scene: Scene, energy: float) -> float:
    """A depth, m, that no impact of this energy, J, goes far beyond: elastic, or little resistance of what overlaps,
    less its weight.
    """
    geometry, profile = scene.geometry, scene.profile
    modulus = geometry.shape.modulus(geometry.material).relaxed
    strength = SOFTEST * (geometry.material.yield_strength or np.inf)
    curve, depth = profile.load_curve, profile.hertz_impact(modulus, scene.reduced_mass, scene.velocity).depth

    def work(deepest: float) -> float:
        places = deepest * (np.arange(64) + 0.5) / 64
        areas = np.pi * np.array([(profile.fixed_radius or overlapping(profile, float(d))) ** 2 for d in places])
        pressed = np.minimum(modulus * np.asarray(curve.force(places)), strength * areas)
        return float(pressed.mean() - scene.reduced_mass * scene.gravity) * deepest

    while work(depth) < energy:
        depth *= 1.15
    return depth


@dataclass(frozen=True, eq=False)
class Striking:
    """The way of an impact on what yields."""

    scene: Scene
    chosen: Plan
    progress: Progress
    course: Course
    rounds: ClassVar[int] = ROUNDS

    @classmethod
    def of(cls, scene: Scene, chosen: Plan, progress: Progress) -> Striking:
        """Raises NotReached where not even a coarse mesh tells how deep it goes."""
        return cls(scene, chosen, progress, pilot(scene).course)

    def certified(self, numerics: Numerics) -> Budget:
        """The contact and its bars. Raises NotReached."""
        wider = numerics.contact_radius / self.chosen.numerics.contact_radius
        return within_core(self.course.outgrown(wider), partial(self._budget, numerics))

    def _budget(self, numerics: Numerics, course: Course) -> Budget:
        runner = Runner(self.scene, course, self.progress)
        runs = Varied.of(runner.run, numerics, self.course.coarsest(numerics))
        told, works = Varied(*(run.answered for run in runs)), [run.work for run in runs]
        mended = told.mended(_onwards)
        march = runner.motion(mended).march(runs.base.work)
        curve = curve_of(march, self.scene)
        self._check_end(curve.duration)
        pairs = told.pairs(_onwards, self.course.settling(numerics))
        pairs["time_step"] += (misfit(mended, told),)
        changes = {cause: tuple(runner.variation(pair) for pair in own) for cause, own in pairs.items()}
        work = TotalWork.of(works, runs.base.unknowns, sum(one.iterations for one in works), 0)
        return Budget(curve, march, changes, work, numerics)

    def _check_end(self, duration: float) -> None:
        """Raise BadInput for an end of the motion amid the contact."""
        if duration > self.scene.end_time:
            told = f"{self.scene.end_time:g} s: the contact lasts {duration:.3g} s; accepted: longer, or none"
            raise BadInput(Fault(self.scene.source, "motion.end_time", told))

    def finer(self, found: Budget) -> Finer:
        """Less of the causes that stand in the way."""
        if meets(found.quantities, found.numerics.tolerance):
            return Finer(None)
        shares = {cause: shares_of(found, cause) for cause in CAUSES}
        return Finer(finer(shares, found.numerics, self.chosen.pinned))

    def ledger(self, found: Budget) -> tuple[LedgerEntry, ...]:
        """What the model leaves out of the impact that was found."""
        return model_ledger(self.scene, Peak.of(found.quantities, found.history()))


def curve_of(march: March, scene: Scene) -> Curve:
    """The curve of a march, whose force peaks where its depth does."""
    return replace(Curve.of(march, Strike.of(scene)), peaked_at=float(march.time[march.depth.argmax()]))


def plan(scene: Scene, given: Given) -> Plan:
    """Settings and ledger, by a coarse run. Raises NotReached."""
    check(scene, given)
    known = pilot(scene)
    radius, about = float(known.march.radius.max()), curve_of(known.march, scene).quantities
    duration, peak_time = about["duration"] or 0.0, about["peak_time"] or 0.0
    numerics = replace(
        settings(given, known.course),
        contact_radius=radius,
        contact_time=duration,
        peak_share=peak_time / duration,
    )
    peak = Peak(about["peak_force"] or 0.0, about["peak_depth"] or 0.0, radius, duration)
    return Plan(numerics, frozenset(given) - {"tolerance"}, model_ledger(scene, peak))


def check(scene: Scene, given: Given) -> None:
    """Raise BadInput for settings that are not for what yields; what is not built, the scene refuses itself."""
    check_kind(given, False, scene.source)
    check_given(given, scene.source, scene.profile)


def expected(scene: Scene, given: Given) -> tuple[float, float]:
    """Tolerance, and processor time, s, about. Raises BadInput."""
    check(scene, given)
    tolerance = tolerance_of(given)
    return tolerance, SECONDS * max(SO_LOOSE / tolerance, 1.0) ** TIGHTER


def fe(scene: Scene, given: Given, progress: Progress = silent) -> Result:
    """Force history, error bars and the indentation left for ever. Raises NotReached."""
    found = solved(scene, given, progress, plan, Striking.of)
    return record(scene, found, dent_left(found.certified))


YIELDING = ImpactModel(check, plan, expected, fe)


@dataclass(frozen=True, eq=False)
class YieldRun:
    """One impact with some settings: what the body ``answered``, and what it cost."""

    answered: Answered
    work: Work
    unknowns: int


@dataclass(frozen=True, eq=False)
class Runner:
    """Impacts of a scene with settings varied."""

    scene: Scene
    course: Course
    progress: Progress

    def run(self, numerics: Numerics, cut: bool) -> YieldRun:
        """A loading beyond where the energy is spent, and a release from there. Raises NotReached."""
        loading, known, places = self.pressed(numerics, cut)
        found = answered(loading, known, places, released_power(self.course))
        counts = loading.presser.counts
        work = Work(len(loading.ends), counts.problems, counts.iterations)
        return YieldRun(found, work, loading.presser.ground.unknowns)

    def pressed(self, numerics: Numerics, cut: bool) -> tuple[PlasticLoading, Answered, list[Station]]:
        """The same: loading, what is known by it, and places of the release."""
        loading = PlasticLoading.with_progress(self.course, numerics, cut, self.progress)
        loading.to(BEYOND * self.course.deepest)
        known = Answered.of(loading)
        deepest = self.motion(known).deepest
        if deepest > known.depth[-1]:
            raise MemoryTooSmall(self.course.unit)
        return loading, known, let_go(loading, deepest, released_power(self.course))

    def motion(self, answer: Answered) -> Rebound:
        """The striker's, on what answers so."""
        return Rebound.of(answer, self.scene, self.course)

    def variation(self, pair: Contrast[Answered]) -> Variation:
        """Of the striker's motion."""
        first, second = (
            curve_of(self.motion(answer).march(Work()), self.scene) for answer in (pair.first, pair.second)
        )
        return Variation(first, second, pair.factor)
