"""The error of a law over its free parameters, the peak held where that is asked for, and how well a fit is known.

One impact of a law, as a fit needs it: depth and force at any time, and the peak, at the least cost. Certainty is the
covariance by the linearized least squares, intervals, and what to be warned of.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Set
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from lumped import laws
from lumped.errors import BadInput, NotReached
from lumped.fit.measured import Measured
from lumped.fit.record import Estimate
from lumped.fit.space import TOUCH, Space
from lumped.laws._force_law import ForceLaw, bodies_of
from lumped.laws._hereditary import HereditaryLaw, Solve, once
from lumped.numbers import local
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.schema.keys import Number
from lumped.solvers.point.contact import motion
from lumped.solvers.point.track import PointTrack, peak_of

Array = NDArray[np.float64]
Values = Mapping[str, float]
# How the peak answers to a stiffness, about: the first step of the root solve.
PEAK_POWER = 0.4
# Rounding: of the logarithm of the peak over the measured one; work: solves for it, more is no convergence.
PEAK_TOLERANCE, MOST_SOLVES = 1e-11, 40
LARGEST_STEP = 3.0  # safety: of the logarithm of a stiffness, in one step of that search
# Below what the differences of a Jacobian see.
STEP_TOLERANCE, INTEGRATOR_TOLERANCE, RESULT_TOLERANCE = 1e-8, 1e-9, 1e-6
PLACES = 801  # times of the contact at which depth and force are read
CONFIDENCE = 0.95  # of the intervals
# Steps of the differences, of the value or of this share of its guess, whichever is larger: a damping near zero has
# no size of its own.
STEP, LEAST_SHARE = 1e-3, 0.01
# Residuals per relative change: below the first nothing is felt, above the second ratio two are one.
UNFELT, ALIKE = 1e-9, 1e8
CORRELATED = 0.99  # two parameters whose correlation lies beyond are named in a warning
SYSTEMATIC = "neighbouring residuals are alike: what is left is the law's own error, and no interval holds it"
AT_BOUND = 1e-6  # rounding: of the value, or for the touch of the duration: as near to its bound it lies on it
SAYS_NOTHING = 100.0  # times the value: an interval as wide is the linearization's, and tells no more than none
FORCE = Number(-math.inf, math.inf, "N")


@dataclass(frozen=True, eq=False)
class FitProblem:
    """`dependent` is the free parameter that holds the peak, "(26)"; None: least squares in all of them."""

    space: Space
    measured: Measured
    dependent: str | None

    @property
    def searched(self) -> tuple[str, ...]:
        """The free parameters that the least squares find."""
        return tuple(name for name in self.space.free if name != self.dependent)

    def candidate(self, values: Values) -> Candidate:
        """The impact at these values of all free parameters. Raises BadInput, NotReached."""
        return candidate(self.space.law, self.space.scene_at(values))

    def error(self, values: Values) -> Array:
        """Residuals at all points, relative to the peak. Raises BadInput, NotReached."""
        return self.error_of(values, self.candidate(values))

    def error_of(self, values: Values, found: Candidate) -> Array:
        """Residuals of an impact that has been computed."""
        return self.measured.error_of(found.force(self.measured.time - self.space.touch(values)))

    def whole(self, searched: Values, near: Values) -> dict[str, float]:
        """All free parameters, in their order: the dependent one from the peak, from `near` on. Raises NotReached."""
        if self.dependent is None:
            return {name: searched[name] for name in self.space.free}
        held = {self.dependent: self._of_peak(self.dependent, searched, near[self.dependent])}
        return {name: {**searched, **held}[name] for name in self.space.free}

    def _of_peak(self, name: str, searched: Values, near: float) -> float:
        """The value of the parameter `name`, by secants in logarithms, at which the peak is the measured one."""
        low, high = (math.log(end) for end in self.space.limits(name, near))

        def excess(x: float) -> float:
            return math.log(self.candidate({**searched, name: math.exp(x)}).peak / self.measured.peak)

        place = math.log(near)
        off, slope = excess(place), PEAK_POWER
        for _ in range(MOST_SOLVES):
            if abs(off) < PEAK_TOLERANCE:
                return math.exp(place)
            step = -math.copysign(min(abs(off / slope), LARGEST_STEP), off / slope)
            there = min(max(place + step, low), high)
            if there == place:
                break
            try:
                off_there = excess(there)
            except BadInput:
                break
            slope = (off_there - off) / (there - place) or slope
            place, off = there, off_there
        raise NotReached(
            f"no {name} gives the measured peak, {self.measured.peak:.6g} N: at {math.exp(place):.6g} it is "
            f"{100.0 * math.expm1(off):+.3g} % off; cure: free another parameter, or fit without holding the peak"
        )


@dataclass(frozen=True)
class Candidate:
    """`columns` maps times from zero to `end`, s, to depth, m, and force, N, shape (2, n); `peak` in N."""

    columns: Callable[[Array], Array]
    peak: float
    end: float

    def force(self, time: Array) -> Array:
        """F at any times since touch, N: none before touch and after the end."""
        inside = (time >= 0.0) & (time <= self.end)
        return np.where(inside, self.columns(np.clip(time, 0.0, self.end))[1], 0.0)

    def half_depth(self) -> float:
        """Half of the greatest depth, m."""
        return 0.5 * float(self.columns(np.linspace(0.0, self.end, PLACES))[0].max())

    def force_at_depth(self, depth: float) -> float:
        """F in the approach at a depth, N."""
        inward, force = self.columns(np.linspace(0.0, self.end, PLACES))
        way = slice(0, int(np.argmax(inward)))
        return float(local(inward[way], force[way], np.array([depth]))[0])


def candidate(name: str, scene: Scene) -> Candidate:
    """The impact of a scene by the law of this name. Raises BadInput, NotReached."""
    law = laws.get(name).of(scene)
    if isinstance(law, ForceLaw):
        return _of_force_law(law, scene)
    if isinstance(law, HereditaryLaw) and law.solve is not None:
        return _of_memory(law.solve, scene)
    return _of_result(law.simulate(scene, RESULT_TOLERANCE))


def _of_force_law(law: ForceLaw, scene: Scene) -> Candidate:
    until = scene.end_time_of(law.elastic_contact_time(scene))
    track = PointTrack(law, motion(law, bodies_of(scene), law.exit, 1, until, STEP_TOLERANCE))
    (contact,) = track.motion.contacts

    def columns(time: Array) -> Array:
        depth, _, force = track(time)
        return np.array([depth, np.maximum(force, 0.0) if law.exit == "force" else force])

    return Candidate(columns, peak_of(track, contact)[1], contact.end_time)


def _of_memory(solve: Solve, scene: Scene) -> Candidate:
    answer = once(scene, INTEGRATOR_TOLERANCE, solve)
    return Candidate(lambda time: answer.columns(time)[[0, 2]], answer.values["peak_force"] or 0.0, answer.times[-1])


def _of_result(result: Result) -> Candidate:
    history, peak = result.history, result.quantities["peak_force"].value or 0.0
    return Candidate(lambda t: np.array([history.resampled(t).depth, history.force_at(t)]), peak, history.time[-1])


@dataclass(frozen=True, eq=False)
class Certainty:
    """Covariance of the values of all free parameters, their intervals, and those of the force at `depth`, m."""

    covariance: Array
    parameters: Mapping[str, Estimate]
    depth: float
    force_at_depth: Estimate
    warnings: tuple[str, ...]

    @property
    def correlation(self) -> Array:
        """The correlation matrix; one on its diagonal also where nothing varies."""
        return correlation_of(self.covariance)


def certainty_of(problem: FitProblem, values: Mapping[str, float], guess: Mapping[str, float]) -> Certainty:
    """At the solution `values`, by central differences around it. Raises NotReached."""
    names = tuple(problem.space.free)
    found = problem.candidate(values)
    depth = found.half_depth()
    error, force = problem.error_of(values, found), found.force_at_depth(depth)
    slopes = _slopes(problem, values, guess, depth)
    of_error = slopes[len(names) + 1 :]
    felt = np.linalg.norm(of_error, axis=0) * _scales(problem, values, guess) > UNFELT
    inverse, told = _inverse(of_error[:, felt], _scales(problem, values, guess)[felt])
    freedom = problem.measured.points - len(problem.searched)
    every = slopes[: len(names) + 1, felt]
    spread = every @ inverse @ every.T * float(error @ error) / freedom
    widths = _student(freedom) * np.sqrt(np.diag(spread)) if told and felt.any() else np.full(len(names) + 1, np.nan)
    unfelt = {name for name, known in zip(problem.searched, felt, strict=True) if not known}
    unknown = unfelt | {name for name in names if _at_bound(problem, name, values[name], guess)}
    scales = {name: problem.measured.duration if name == TOUCH else max(values[name], guess[name]) for name in names}
    parameters = {
        name: _estimate(values[name], math.nan if name in unknown else width, problem.space.free[name], scales[name])
        for name, width in zip(names, widths.tolist(), strict=False)
    }
    covariance = spread[:-1, :-1]
    warnings = [
        *_parameter_warnings(problem, parameters, guess, unfelt),
        *_pair_warnings(problem, covariance, told),
        *((SYSTEMATIC,) if problem.measured.systematic(error) else ()),
    ]
    of_force = _estimate(force, float(widths[-1]), FORCE, found.peak)
    return Certainty(covariance, parameters, depth, of_force, tuple(warnings))


def correlation_of(covariance: Array) -> Array:
    """The correlation matrix of a covariance."""
    spread = np.sqrt(np.diag(covariance))
    scale = np.where(spread > 0.0, spread, 1.0)
    matrix = covariance / np.outer(scale, scale)
    np.fill_diagonal(matrix, 1.0)
    return np.asarray(matrix)


def _scales(problem: FitProblem, values: Mapping[str, float], guess: Mapping[str, float]) -> Array:
    """The size of every parameter searched."""
    return np.array(
        [
            problem.measured.duration if name == TOUCH else max(values[name], LEAST_SHARE * guess[name])
            for name in problem.searched
        ]
    )


def _slopes(problem: FitProblem, values: Mapping[str, float], guess: Mapping[str, float], depth: float) -> Array:
    """How all free values, the force at `depth` and the residuals change with each parameter searched."""
    names = problem.searched

    def state(changed: Mapping[str, float]) -> Array:
        whole = problem.whole(changed, values)
        found = problem.candidate(whole)
        known = [whole[name] for name in problem.space.free]
        return np.concatenate([known, [found.force_at_depth(depth)], problem.error_of(whole, found)])

    def aside(name: str, place: float) -> tuple[float, Array]:
        """The state with one value changed; the state found where no law has that value beside the others."""
        try:
            return place, state({**values, name: place})
        except (BadInput, NotReached):
            return values[name], state(values)

    columns = []
    for name, scale in zip(names, _scales(problem, values, guess), strict=True):
        low, high = problem.space.limits(name, guess[name])
        below, before = aside(name, max(values[name] - STEP * scale, low))
        above, after = aside(name, min(values[name] + STEP * scale, high))
        if above == below:
            raise NotReached(f"no law has another {name} than {values[name]:.6g}; cure: hold it, or free another one")
        columns.append((after - before) / (above - below))
    size = len(problem.space.free) + 1 + problem.measured.time.size
    return np.array(columns).T if columns else np.zeros((size, 0))


def _inverse(slopes: Array, scales: Array) -> tuple[Array, bool]:
    """(J^T J)^-1 of the values, and whether the parameters can be told apart; NaN where they cannot."""
    if not scales.size:
        return np.zeros((0, 0)), True
    _, singular, axes = np.linalg.svd(slopes * scales, full_matrices=False)
    if not singular[0] < ALIKE * singular[-1]:
        return np.full((scales.size, scales.size), np.nan), False
    spread = axes.T / singular * scales[:, None]
    return spread @ spread.T, True


def _student(freedom: int) -> float:
    """Student's t of the two-sided confidence."""
    from scipy.special import stdtrit

    return float(stdtrit(freedom, 0.5 + 0.5 * CONFIDENCE))


def _estimate(value: float, width: float, key: Number, scale: float) -> Estimate:
    """A value with its interval, cut where the parameter ends; none of a width that is not known, or says nothing."""
    if not width <= SAYS_NOTHING * scale:
        return Estimate(value, None, None, key.unit)
    return Estimate(value, max(value - width, key.low), min(value + width, key.high), key.unit)


def _at_bound(problem: FitProblem, name: str, value: float, guess: Mapping[str, float]) -> bool:
    """Whether a free parameter lies where the search may go no further."""
    low, high = problem.space.limits(name, guess[name])
    near = AT_BOUND * (problem.measured.duration if name == TOUCH else abs(value))
    return min(value - low, high - value) <= near


def _parameter_warnings(
    problem: FitProblem, parameters: Mapping[str, Estimate], guess: Mapping[str, float], unfelt: Set[str]
) -> Iterator[str]:
    for name, estimate in parameters.items():
        if name in unfelt:
            yield f"{name} does not change the force around {estimate.value:.6g}: the curve does not tell it"
        elif _at_bound(problem, name, estimate.value, guess):
            yield f"{name} is at its bound, {estimate.value:.6g}: it has no interval"
        elif estimate.low is None:
            yield f"{name} has no interval: the curve hardly tells it"
        elif estimate.low <= problem.space.free[name].low:
            yield f"the interval of {name} reaches the least value it can have: the curve does not tell it from none"


def _pair_warnings(problem: FitProblem, covariance: Array, told: bool) -> Iterator[str]:
    names = tuple(problem.space.free)
    if not told:
        yield f"{', '.join(names)} are not told apart by this curve: hold one of them; intervals are left out"
        return
    correlation = correlation_of(covariance)
    for i, j in combinations(range(len(names)), 2):
        if problem.dependent not in (names[i], names[j]) and abs(correlation[i, j]) > CORRELATED:
            yield (
                f"{names[i]} and {names[j]} are correlated by {correlation[i, j]:+.4f}: hold one of them, or rely on "
                "the force at half depth"
            )
