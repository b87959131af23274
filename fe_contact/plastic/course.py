"""A loading of a half-space that yields, and its release: from a scene's bodies and settings to smooth curves.

As the body flows through its elements the force goes up and down, by 1e-4 to 5e-4 under a contact that grows, and from
step to step by 1e-3 under a rim: noise without a trend. So a force is a smooth function of the depth through those of
all steps, some of which go deeper than asked; two meshes then differ by their trends, and a third of their noise. Where
the body begins to yield the force's curvature begins at once: before it the force is a power of the depth, but for what
the profile is none, and from there on it leaves that with its slope.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Set
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Generic, NamedTuple, TypeVar

import numpy as np

from fe_contact.assembly.forms import Array, check_compressible
from fe_contact.budget.refine import Growth, missing
from fe_contact.budget.variation import SAFETY
from fe_contact.plastic.ground import CORE, WIDEST, Ground, Sizes, ground_of, yielding_of
from fe_contact.plastic.path import ELASTIC_RATIO, PlasticZoneWide, Presser, Station
from fe_contact.progress import Count, Counted, Progress, uncounted
from fe_contact.settings import DEFAULT_TOLERANCE, RANGES, Given, Numerics, tolerance_of
from lumped.errors import BadInput, Fault
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Scene
from lumped.shapes import Shape

Told = TypeVar("Told")
Smooth = Callable[[Array], Array]
BEYOND = 1.2  # of the largest depth: up to there forces are found, so that it lies amid them
KNOTS = 0.35  # between knots of a smooth force, in ln depth: 1 misses it by 4e-4 after first yield, 1/4 follows noise
RIM_KNOTS = 0.25  # the same under a rim, where no edge moves
RADIUS_KNOTS = 1.0  # the same of a smooth contact radius, which jumps from point to point
ELASTIC_DEGREE = 3  # at most, of a force over its power before anything yields
NARROWER = 0.5  # knots that tell what these ones miss
SAMPLES = 2  # of a curve between two of its knots, about, at least
FAINT, FIRM = 0.5, 0.9  # of the yield strength, mean elastic pressures: before them nothing yields, and hardly anything
FEWEST = 6  # forces of a smooth curve at least
STRIDE = 6.0  # over the settings' steps: of a step in depth, over the depth
SHALLOWEST = 1e-6  # depth of the first step over the largest, at least: that shallow, yielding is forgotten soon
FORGOTTEN = 0.3  # of the shallowest depth, the first step of what flows from the touch on: the next ones forget it
BISECTIONS = 60  # work
ELEMENTS = 8.0  # along the contact radius, at 1e-3
COARSER, RIM_COARSER = 0.4, 0.5  # of the elements, on the coarsest of three meshes: half of them differ by noise
RIM_ELEMENTS = 2.0  # the same under a rim, which the mesh is refined to, where a body begins to yield
LEAST_STEPS = 16  # to begin with
LEAST_ELEMENTS, LEAST_RIM_ELEMENTS = 4.0, 2.0  # that a user may choose
COARSEST = 3.0  # elements of a mesh that tells something, where no rim is
LOOSEST = 1.5  # times as many has the finest mesh at a loose tolerance
MOST_ELEMENTS, MOST_STEPS = 32.0, 320  # to begin with
ORDER = 3  # of the elements: they do not lock where flow keeps the volume
STEPS, RIM_STEPS = 33, 18  # of a loading over six e-folds of the depth or so, there and where a body begins to yield
# Powers of the tolerance that elements and steps follow. More steps than that carry on more of what carrying errs by.
FOLLOWING, STEPS_FOLLOWING, RIM_FOLLOWING = 0.4, 0.6, 0.4
FURTHER, FURTHEST = 0.35, 40.0  # power of the depth over that of first yield that steps follow too, up to there
FEWEST_STEPS = 6  # of a run that tells anything
# Of forces: 2.3 to 4.6 where an edge is a node of a growing mesh, but for noise; the least under a rim, and of meshes
# that are less than so many times as fine as each other: they differ by noise as much.
MESH_ORDER, LEAST_ORDER, APART = 2.0, 1.0, 2.0
ONWARDS = 1.0 / 3.0  # of what half the steps change: their square counts out (Richardson)
NOISY = 1.3  # of bars, by which they may scatter from mesh to mesh
# Where flow turns under an edge, bars fall with the settings to 1.5 to 2.
GROWTH = {
    "mesh": Growth(order=2.0, step=1.1, most=1.6, work=2.0),
    "penalty": Growth(order=1.0, step=2.0, most=4.0, work=0.1),
    "time_step": Growth(order=1.5, step=1.2, most=2.0, work=1.5),
    "far_field": Growth(order=2.0, step=1.5, most=2.0, work=0.3),
}
DEFAULTS: Given = {
    "order": ORDER,
    "penalty": 64000.0,
    "enforcement": "corrected",
    "scheme": "galerkin",
    "far_radius": 60.0,
}


def finer(shares: Mapping[str, Array], numerics: Numerics, pinned: Set[str]) -> Numerics | None:
    """Settings with which errors are predicted to meet the tolerance, None where nothing helps.

    ``shares`` (n,) of the tolerance, by cause.
    """
    found = missing({cause: NOISY * share for cause, share in shares.items()}, GROWTH, numerics, pinned)
    found = found.varied(steps=4 * math.ceil(found.steps / 4))
    return None if found == numerics else found


def check_given(given: Given, source: str, profile: Shape) -> None:
    """Raise BadInput for settings of bodies that do not yield, and for fewer elements than show a contact's edge."""
    found = [
        Fault(source, f"numerics.{key}", f"{given[key]}: with model.plasticity there is no choice; leave it out")
        for key in ("scheme", "enforcement")
        if key in given and given[key] != DEFAULTS[key]
    ]
    least, (_, most) = LEAST_RIM_ELEMENTS if profile.fixed_radius else LEAST_ELEMENTS, RANGES["elements_per_contact"]
    if given.get("elements_per_contact", least) < least:
        reason = f"{given['elements_per_contact']:g}: with model.plasticity accepted from {least:g} to {most:g}"
        found.append(Fault(source, "numerics.elements_per_contact", f"{reason}; fewer show no edge"))
    if found:
        raise BadInput(found)


@dataclass(frozen=True, eq=False)
class Forces:
    """Forces (n,), N, and contact radii, m, at depths (n,), m, and the smooth curves through them.

    ``elastic``: how many of them lie before the body yields, where the force is nearly a ``power`` of the depth.
    """

    depth: Array
    force: Array
    radius: Array
    power: float
    knots: float
    elastic: int

    @cached_property
    def _beside(self) -> Array:
        """Logarithms of the forces over that power of the depth."""
        return np.asarray(np.log(self.force) - self.power * np.log(self.depth))

    @cached_property
    def _before(self) -> np.polynomial.Polynomial:
        """Of the same, while nothing yields: a constant but for what the profile is no power and for noise."""
        x, degree = np.log(self.depth[: self.elastic]), min((self.elastic - 1) // 2, ELASTIC_DEGREE)
        return np.polynomial.Polynomial.fit(x, self._beside[: self.elastic], degree, domain=[x[0], x[0] + 1.0])

    @cached_property
    def _after(self) -> Smooth:
        """Of the same, over all depths."""
        x, count = np.log(self.depth), self.elastic
        if count == 0:
            return smooth(x, self._beside, self.knots)
        elastic = self._before
        if count == x.size:
            return elastic
        begins = _onset(x[count - 1 :], (self._beside - elastic(x))[count - 1 :])
        level, slope = elastic(begins), elastic.deriv()(begins)
        beyond = x[x > begins] - begins
        bends = smooth(beyond, self._beside[x > begins] - level - slope * beyond, self.knots, rising=True)

        def of(x: Array) -> Array:
            beyond = np.maximum(x - begins, 0.0)
            return np.asarray(elastic(np.minimum(x, begins)) + slope * beyond + bends(beyond))

        return of

    @cached_property
    def _squared(self) -> Smooth:
        return smooth(np.log(self.depth), np.log(self.radius), RADIUS_KNOTS)

    def logarithm(self, depth: Array) -> Array:
        """Of the force at depths, m; before the first one it is a power of the depth."""
        inside = np.clip(depth, self.depth[0], self.depth[-1])
        deep = np.log(np.maximum(depth, np.finfo(float).tiny))
        return np.asarray(self._after(np.log(inside)) + self.power * np.minimum(deep, math.log(self.depth[-1])))

    def misfit(self, depth: Array) -> Array:
        """What narrower knots change of that, and what it misses before yielding: trends, and some noise."""
        changed = replace(self, knots=NARROWER * self.knots).logarithm(depth) - self.logarithm(depth)
        if self.elastic == 0:
            return changed
        missed = self._beside[: self.elastic] - self._before(np.log(self.depth[: self.elastic]))
        return np.asarray(changed + np.copysign(np.abs(missed).max(), changed))

    def contact_radius(self, depth: Array) -> Array:
        """At depths, m; there in proportion to the root of force over depth."""
        inside = np.clip(depth, self.depth[0], self.depth[-1])
        before = np.minimum(np.log(np.maximum(depth, np.finfo(float).tiny) / self.depth[0]), 0.0)
        return np.asarray(np.exp(self._squared(np.log(inside)) + (self.power - 1.0) * before))


def _onset(x: Array, lost: Array) -> float:
    """Between the first two of places x (n,), ascending, where a parabola through the next two ends: what is ``lost``
    begins there.
    """
    if x.size < 3:
        return float(x[0])
    first, second = np.sqrt(np.maximum(-lost[1:3], 0.0))
    back = first * (x[2] - x[1]) / (second - first) if second > first else np.inf
    return float(max(x[1] - back, x[0]))


def smooth(x: Array, y: Array, spacing: float, rising: bool = False) -> Smooth:
    """The cubic spline nearest to samples (n,), its knots a ``spacing`` apart, or further.

    ``rising``: it begins at zero, with no slope, and is a polynomial of less degree where there are fewer samples.
    """
    from scipy.interpolate import BSpline  # late: only what yields needs it

    held, start = (2, 0.0) if rising else (0, x[0])
    degree = min(3, x.size + held - 1)
    inner = _inner(np.append(start, x) if rising else x, spacing)
    knots = np.concatenate([np.full(degree + 1, start), inner, np.full(degree + 1, x[-1])])
    shapes = BSpline.design_matrix(x, knots, degree).toarray()[:, held:]
    found = BSpline(knots, np.concatenate([np.zeros(held), np.linalg.lstsq(shapes, y, rcond=None)[0]]), degree)
    return lambda x: np.asarray(found(x))


def _inner(x: Array, spacing: float) -> Array:
    """Knots between the first and the last of places x (n,), a spacing apart, or more where samples are sparse."""
    passed = np.concatenate([[0.0], np.cumsum(np.minimum(np.diff(x) / spacing, 1.0 / SAMPLES))])
    intervals = max(1, round(passed[-1]))
    return np.asarray(np.interp(passed[-1] / intervals * np.arange(1, intervals), passed, x))


@dataclass(frozen=True)
class Course:
    """What is pressed into what, and how deep; m, Pa. ``first``, ``firm``: depths before which nothing yields, and
    hardly anything; ``core``: up to so many contact radii away it may.
    """

    profile: Shape
    poisson: float
    modulus: float
    strength: float
    hardening: float
    first: float
    firm: float
    deepest: float
    core: float = CORE

    @classmethod
    def of(cls, scene: Scene | Indenter, shallowest: float, deepest: float) -> Course:
        """From and to a depth, m, which has to be known about."""
        check_compressible(scene)
        geometry = scene.geometry
        material, profile = geometry.material, scene.profile
        modulus = geometry.shape.modulus(material).relaxed
        strength = material.yield_strength
        assert strength is not None  # see plasticity_faults
        faint, firm = (_depth_of(profile, share * strength / modulus, deepest) for share in (FAINT, FIRM))
        shallow = min(shallowest, deepest / 4.0)
        first = min(max(faint, SHALLOWEST * deepest), shallow) if faint > 0.0 else FORGOTTEN * shallow
        return cls(
            profile=profile,
            poisson=material.nu,
            modulus=modulus,
            strength=strength,
            hardening=material.hardening_modulus or 0.0,
            first=first,
            firm=max(firm, first),
            deepest=deepest,
        )

    def starting_at(self, depth: float) -> Course:
        """With no step before a depth, m: what flows there forgets how it began."""
        return replace(self, first=max(self.first, depth), firm=max(self.firm, depth))

    def outgrown(self, wider: float) -> Course:
        """For contacts so many times as wide, where they outgrew what was expected."""
        return replace(self, deepest=self.deepest * wider**2)

    @property
    def rim(self) -> bool:
        """Whether all contacts end at a rim."""
        return self.profile.fixed_radius is not None

    @cached_property
    def unit(self) -> float:
        """The length, m, in which places of the loading are told: about the widest contact."""
        return self.profile.fixed_radius or overlapping(self.profile, BEYOND * self.deepest)

    def coarsest(self, numerics: Numerics) -> float:
        """Elements along the contact radius of the coarsest of three meshes."""
        elements = numerics.elements_per_contact
        return RIM_COARSER * elements if self.rim else max(COARSER * elements, COARSEST)

    def settling(self, numerics: Numerics) -> float:
        """By how much errors are trusted to fall from one of these meshes to the next."""
        finer = numerics.elements_per_contact / self.coarsest(numerics)
        return float(finer ** (0.5 * (MESH_ORDER if finer >= APART and not self.rim else LEAST_ORDER)))

    @property
    def power(self) -> float:
        """Of the depth that a force is in proportion to before anything yields."""
        return self.profile.exponent_of_force

    def ground(self, numerics: Numerics, cut: bool = False) -> Ground:
        """The half-space meshed. Raises BodyTooFine."""
        sizes = Sizes(
            elements=numerics.elements_per_contact,
            order=numerics.order,
            far_radius=numerics.far_radius,
            core=self.core,
            rim=self.rim,
            cut=cut,
        )
        yielding = yielding_of(self.poisson, self.strength / self.modulus, self.hardening / self.modulus)
        return ground_of(self.profile, self.unit, yielding, self.poisson, sizes)

    def depths(self, steps: int, end: float) -> Array:
        """Ends of the steps, m: coarse where nothing yields."""
        firm = min(self.firm, end)
        before = _spread(self.first, firm, ELASTIC_RATIO) if firm > self.first else np.array([self.first])
        after = _spread(before[-1], end, 1.0 + STRIDE / steps) if end > before[-1] else before[-1:]
        found = np.concatenate([before, after[1:]])
        return found if found.size > FEWEST else np.geomspace(self.first, end, FEWEST + 1)


def within_core(course: Course, told: Callable[[Course], Told]) -> Told:
    """What is ``told`` of a course, or of one with a wider core where flow leaves it. Raises PlasticZoneWide."""
    try:
        return told(course)
    except PlasticZoneWide:
        if course.core >= WIDEST:
            raise
    return within_core(replace(course, core=2.0 * course.core), told)


def _spread(start: float, end: float, ratio: float) -> Array:
    """Depths from start to end, no further apart than a ratio."""
    count = max(1, int(np.ceil(np.log(end / start) / np.log(ratio) - 1e-9)))
    return np.geomspace(start, end, count + 1)


def overlapping(profile: Shape, depth: float) -> float:
    """Radius up to which the undeformed surfaces overlap, m."""
    return _largest(lambda radius: float(profile.height(radius)) < depth, depth)


def _depth_of(profile: Shape, pressure: float, deepest: float) -> float:
    """Depth, m, at which the mean elastic pressure reaches one over E*; zero where it is higher from the touch on."""
    curve = profile.load_curve

    def lower(depth: float) -> bool:
        area = np.pi * float(curve.contact_radius(depth)) ** 2
        return bool(float(curve.force(depth)) < pressure * area)

    least, most = 1e-9 * deepest, 16.0 * deepest
    return min(_largest(lower, least, most), most) if lower(least) else 0.0


def _largest(holds: Callable[[float], bool], start: float, most: float = np.inf) -> float:
    """The largest number for which something holds, by doubling and bisection."""
    low, high = 0.0, start
    while high < most and holds(high):
        low, high = high, 2.0 * high
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if holds(middle) else (low, middle)
    return high


def settings(given: Given, course: Course) -> Numerics:
    """Settings of a body that yields: what the user left open. The further it yields, the more steps, and the finer
    the elements about a rim.
    """
    tolerance = tolerance_of(given)
    tighter, further = DEFAULT_TOLERANCE / tolerance, min(course.deepest / course.firm, FURTHEST) ** FURTHER
    if course.rim:
        finer = tighter**RIM_FOLLOWING * further
        fewest, wanted, steps = RIM_ELEMENTS, RIM_ELEMENTS * finer, RIM_STEPS * finer
    else:
        fewest, wanted = LOOSEST * COARSEST, ELEMENTS * tighter**FOLLOWING
        steps = STEPS * tighter**STEPS_FOLLOWING * further
    elements = min(max(wanted, fewest), MOST_ELEMENTS)
    steps = max(4 * round(min(steps, MOST_STEPS) / 4), LEAST_STEPS)
    chosen = {**DEFAULTS, "tolerance": tolerance, "elements_per_contact": elements, "steps": steps}
    return Numerics(**{**chosen, **given}, contact_radius=1.0, contact_time=1.0, peak_share=0.5)


@dataclass(eq=False)
class PlasticLoading:
    """A loading step by step: places at their ends."""

    course: Course
    numerics: Numerics
    presser: Presser
    ends: list[Station]

    @classmethod
    def of(
        cls,
        course: Course,
        numerics: Numerics,
        cut: bool = False,
        most: int | None = None,
        counted: Counted = uncounted,
    ) -> PlasticLoading:
        """Nothing is pressed yet; ``most`` guesses are for it, ``counted`` is told of every contact problem."""
        ground = course.ground(numerics, cut)
        presser = Presser(ground, numerics.penalty, course.unit, course.power - 1.0, most, counted)
        return cls(course, numerics, presser, [])

    @classmethod
    def with_progress(cls, course: Course, numerics: Numerics, cut: bool, progress: Progress) -> PlasticLoading:
        """The same; ``progress`` hears of every contact problem, two or more a step."""
        message = f"{numerics.elements_per_contact:.3g} elements along the contact radius, {numerics.steps} steps"
        problems = 2 * course.depths(numerics.steps, BEYOND * course.deepest).size
        return cls.of(course, numerics, cut, counted=Count.of(progress, message, problems))

    def to(self, end: float) -> None:
        """On to a depth, m, whatever was reached. Raises PlasticFlowLost, PlasticFlowSlow, MemoryTooSmall."""
        course = self.course
        depths = course.depths(self.numerics.steps, end) / course.unit
        if not self.ends:
            radius = overlapping(course.profile, course.first) / course.unit
            here = self.presser.first(float(depths[0]), 1.0 if course.rim else radius)
            self.ends = [here]
        for depth in depths[depths > self.ends[-1].depth * (1.0 + 1e-9)]:
            self.step(float(depth))

    def step(self, depth: float) -> None:
        """One step further, to a depth in units of the course."""
        before, here = self.ends[-2:][0], self.ends[-1]
        taken = list(self.presser.loaded(before, here, depth))
        self.ends[-2:-1] = [place._replace(middle=None) for place in self.ends[-2:-1]]  # memory: no guess needs it
        self.ends += taken

    @property
    def pressed(self) -> Forces:
        """The forces so far, from the first step on that reaches a point of the mesh."""
        course = self.course
        places = [place for place in self.ends if place.force > 0.0]
        depth, force, radius = columns(places)
        yields = [bool(place.state[1].any()) for place in places]
        return Forces(
            depth=course.unit * depth,
            force=course.modulus * course.unit**2 * force,
            radius=course.unit * radius,
            power=course.power,
            knots=RIM_KNOTS if course.rim else KNOTS,
            elastic=yields.index(True) if True in yields else len(yields),
        )


def columns(places: list[Station]) -> Array:
    """Depths, forces and contact radii of places, (3, n)."""
    return np.array([(place.depth, place.force, place.radius) for place in places]).T


class Contrast(NamedTuple, Generic[Told]):
    """Two answers, and the factor that makes an error of what they differ by."""

    first: Told
    second: Told
    factor: float


class Varied(NamedTuple, Generic[Told]):
    """What runs with different settings tell.

    With all steps on three meshes: ``base`` on the finest, ``middle``, ``coarse``. On the coarsest also with half the
    steps, ``fewer``, with twice as many, ``finer``; with half of them and half the penalty, ``softer``, or cut half as
    far away, ``nearer``.
    """

    base: Told
    middle: Told
    coarse: Told
    fewer: Told
    finer: Told
    softer: Told
    nearer: Told

    @classmethod
    def of(cls, run: Callable[[Numerics, bool], Told], numerics: Numerics, coarsest: float) -> Varied[Told]:
        """Of a ``run`` with settings, on a mesh that is cut or not; ``coarsest``: elements along its contact radius."""
        middle = numerics.varied(elements_per_contact=math.sqrt(coarsest * numerics.elements_per_contact))
        coarse = numerics.varied(elements_per_contact=coarsest)
        few = coarse.varied(steps=max(numerics.steps // 2, FEWEST_STEPS))
        return cls(
            base=run(numerics, False),
            middle=run(middle, False),
            coarse=run(coarse, False),
            fewer=run(few, False),
            finer=run(coarse.varied(steps=2 * numerics.steps), False),
            softer=run(few.varied(penalty=0.5 * few.penalty), False),
            nearer=run(few, True),
        )

    @property
    def meshes(self) -> tuple[Told, Told, Told]:
        """The three that differ in nothing else."""
        return self.base, self.middle, self.coarse

    def mended(self, onwards: Callable[[Told, Told, Told, float], Told]) -> Told:
        """The finest mesh with what the coarsest knows of the steps: their square counts out (Richardson).

        ``onwards(one, fine, coarse, weight)``: one + weight (fine - coarse).
        """
        return onwards(self.base, self._fine(onwards), self.coarse, 1.0)

    def _fine(self, onwards: Callable[[Told, Told, Told, float], Told]) -> Told:
        return onwards(self.finer, self.finer, self.coarse, ONWARDS)

    def pairs(
        self, onwards: Callable[[Told, Told, Told, float], Told], settling: float
    ) -> dict[str, tuple[Contrast[Told], ...]]:
        """By cause the pairs that tell its error together.

        From mesh to mesh errors fall by ``settling``: the mean of what two pairs tell of the finest, for two meshes may
        agree by chance; of what is left of the steps once their square counts out, order one is trusted.
        """
        few = onwards(self.coarse, self.coarse, self.fewer, ONWARDS)
        half = 0.5 * SAFETY / (settling - 1.0)
        return {
            "mesh": (Contrast(self.base, self.middle, half), Contrast(self.middle, self.coarse, half / settling)),
            "penalty": (Contrast(self.fewer, self.softer, SAFETY),),
            "time_step": (Contrast(self._fine(onwards), few, SAFETY),),
            "far_field": (Contrast(self.fewer, self.nearer, SAFETY / 3.0),),
        }
