"""How well a fit is known: covariance by the linearized least squares, intervals by profile likelihood, warnings.

Both are in the coordinates of the search, in which the valley of the error is straight: what the curve tells of one
combination alone is no interval of its members.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Set
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from lumped.errors import BadInput, NotReached
from lumped.fit.problem import SOLID, Coordinates, FitProblem, Values
from lumped.fit.profile import MIXED, Ends, Seen, forward_slopes, open_side, student
from lumped.fit.record import LEVEL, Estimate
from lumped.fit.space import TOUCH
from lumped.numbers import Array

STEP = 1e-3  # of the differences
# Residuals per relative change: below the first nothing is felt, above the second ratio two are one.
UNFELT, INSEPARABLE = 1e-9, 1e8
RATIO = "R1"
STRAIGHT = 0.01  # an interval no wider, relatively, to either side is that of the linearization
CORRELATED = 0.99  # two parameters whose correlation lies beyond are named in a warning
SYSTEMATIC = "neighbouring residuals are alike: the law itself errs, or the noise is coloured; no interval holds that"
AT_BOUND = 1e-6  # rounding: of the value, or for the touch of the duration: as near to its bound it lies on it
SAYS_NOTHING = 100.0  # times the peak: an interval of a force as wide tells no more than none


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


def certainty_of(problem: FitProblem, values: Values, guess: Values) -> Certainty:
    """At the solution `values`, by central differences around it. Raises NotReached."""
    around = Surroundings(problem, values, guess)
    names, covariance = tuple(problem.space.free), around.covariance[:-1, :-1]
    sizes = np.array([around.coordinates.size(name, values[name]) for name in names])
    combined = SOLID if around.coordinates.straight else ()
    unfelt = {name for name, felt in zip(problem.searched, around.felt, strict=True) if not felt} - set(combined)
    unknown = {name for name in names if _at_bound(problem, name, values[name], guess)}
    parameters = {name: around.estimate(i, name in unknown) for i, name in enumerate(names)}
    if combined and parameters[RATIO].low is None:
        parameters |= _elastic(parameters)
    warnings = [
        *_parameter_warnings(problem, parameters, guess, unfelt),
        *_pair_warnings(problem, covariance, around.told),
        *((SYSTEMATIC,) if problem.measured.systematic(around.error) else ()),
    ]
    spread = covariance * np.outer(sizes, sizes)
    return Certainty(spread, parameters, around.depth, around.force_at_depth(), tuple(warnings))


def _elastic(parameters: Mapping[str, Estimate]) -> dict[str, Estimate]:
    """What is told of a solid that may as well be elastic: its glassy modulus, of which E0 may be any share.

    A relaxation slow enough is none, whatever its ratio.
    """
    return {
        name: replace(parameters[name], low=None, high=parameters[name].high if name == "E0" else None)
        for name in SOLID
    }


def correlation_of(covariance: Array) -> Array:
    """The correlation matrix of a covariance."""
    spread = np.sqrt(np.diag(covariance))
    scale = np.where(spread > 0.0, spread, 1.0)
    matrix = covariance / np.outer(scale, scale)
    np.fill_diagonal(matrix, 1.0)
    return np.asarray(matrix)


@dataclass(frozen=True, eq=False)
class Surroundings:
    """What changes around a solution: the p free parameters as they are counted, force at a depth, the residuals."""

    problem: FitProblem
    values: Values
    guess: Values

    @cached_property
    def coordinates(self) -> Coordinates:
        """Those of the search, but for what may be zero: a damping beside its guess, for near zero it has no size.

        1 + R1 is the glassy modulus over the relaxed one.
        """
        searched, free = self.problem.searched, self.problem.space.free
        beside = {name: self.guess[name] for name in searched if free[name].low == 0.0}
        beside |= {name: 1.0 for name in searched if name == RATIO}
        return Coordinates(self.problem, self.values, self.guess, beside)

    @cached_property
    def best(self) -> Array:
        """The place of the solution, (q,)."""
        return self.coordinates.place(self.values)

    @cached_property
    def depth(self) -> float:
        """Half of the greatest, m."""
        return self.problem.candidate(self.values).half_depth()

    @cached_property
    def state(self) -> Array:
        """At the solution, (p + 1 + n,)."""
        return self._state(self.best)

    @property
    def error(self) -> Array:
        """The residuals at the solution, (n,)."""
        return self.state[self._first :]

    @property
    def _first(self) -> int:
        """Where the residuals begin."""
        return len(self.problem.space.free) + 1

    def _state(self, place: Array) -> Array:
        """Raises BadInput, NotReached."""
        whole = self.coordinates.whole(place)
        found = self.problem.candidate(whole)
        force = found.force_at_depth(self.depth)
        return np.concatenate([self._counted(whole), [force], self.problem.error_of(whole, found)])

    def _counted(self, whole: Values) -> list[float]:
        return [self.coordinates.counted(name, whole[name]) for name in self.problem.space.free]

    @cached_property
    def slopes(self) -> Array:
        """How the state changes with each coordinate, (p + 1 + n, q). Raises NotReached."""
        columns = [self._slope(i, name) for i, name in enumerate(self.problem.searched)]
        return np.array(columns).T if columns else np.zeros((self.state.size, 0))

    def _slope(self, i: int, name: str) -> Array:
        """By a central difference; to one side where no law lies on the other, or a limit does."""
        sides = [(place, state) for place, state in (self._aside(i, sign * STEP) for sign in (-1.0, 1.0))]
        (below, before), (above, after) = sides
        if above == below:
            raise NotReached(f"no law has another {name} than {self.values[name]:.6g}", "hold it, or free another one")
        return np.asarray((after - before) / (above - below))

    def _aside(self, i: int, step: float) -> tuple[float, Array]:
        """The state beside the solution; that at it where no law has the other value beside the others."""
        there = self.best.copy()
        there[i] = np.clip(there[i] + step, *self._limits[:, i])
        try:
            return float(there[i]), self._state(there)
        except (BadInput, NotReached):
            return float(self.best[i]), self.state

    @cached_property
    def _limits(self) -> Array:
        return self.coordinates.limits()

    @cached_property
    def felt(self) -> NDArray[np.bool_]:
        """Which coordinates change the residuals at all, (q,)."""
        return np.asarray(np.linalg.norm(self.slopes[self._first :], axis=0) > UNFELT)

    @property
    def freedom(self) -> int:
        """Points less what is sought."""
        return self.problem.measured.points - len(self.problem.searched)

    @cached_property
    def _inverse(self) -> tuple[Array, bool]:
        return inverse(self.slopes[self._first :, self.felt])

    @property
    def told(self) -> bool:
        """Whether the coordinates can be told apart."""
        return self._inverse[1]

    @cached_property
    def covariance(self) -> Array:
        """Of the parameters as they are counted, and of the force at the depth, (p + 1, p + 1)."""
        every = self.slopes[: self._first, self.felt]
        return np.asarray(every @ self._inverse[0] @ every.T * float(self.error @ self.error) / self.freedom)

    @cached_property
    def widths(self) -> Array:
        """Half the intervals of the linearization, (p + 1,); NaN where nothing is told."""
        if not self.told or not self.felt.any():
            return np.full(self._first, np.nan)
        return student(self.freedom, LEVEL) * np.sqrt(np.diag(self.covariance))

    def force_at_depth(self) -> Estimate:
        """The force at the depth, N."""
        force, width = float(self.state[self._first - 1]), float(self.widths[-1])
        if not width <= SAYS_NOTHING * self.problem.measured.peak:
            return Estimate(force, None, None, "N")
        return Estimate(force, force - width, force + width, "N")

    def estimate(self, i: int, unknown: bool) -> Estimate:
        """The i-th free parameter with its interval, cut where the parameter ends; none of what is not known."""
        name, key = list(self.problem.space.free.items())[i]
        value, width = self.values[name], float(self.widths[i])
        if unknown or math.isnan(width) or self._mixed(i):
            return Estimate(value, None, None, key.unit)
        if width <= STRAIGHT:
            half = width * self.coordinates.size(name, value)
            return Estimate(value, max(value - half, key.low), min(value + half, key.high), key.unit)
        ends = self._ends.of((i,))[i]
        low, high = (None if end.value is None else self.coordinates.value(name, end.value) for end in ends)
        if high is None and low is not None and low - key.low <= AT_BOUND * value:
            low = None  # from the least that it can have to nowhere
        return Estimate(value, low, high, key.unit)

    def _mixed(self, i: int) -> bool:
        """Whether what changes no residual changes the i-th free parameter."""
        row = self.slopes[i]
        return bool(np.abs(row[~self.felt]).max(initial=0.0) > MIXED * np.linalg.norm(row))

    @cached_property
    def _ends(self) -> Ends:
        least = float(self.error @ self.error)
        bound = least * student(self.freedom, LEVEL) ** 2 / self.freedom
        first = (self.slopes[: self._first - 1], self.slopes[self._first :])
        opened = self.coordinates.opened()
        return Ends(self._seen, self._seen_slopes, self.best, first, self._limits, opened, least + bound, bound)

    def _seen(self, place: Array) -> Seen:
        """Raises BadInput, NotReached."""
        whole = self.coordinates.whole(place)
        return np.array(self._counted(whole)), self.problem.error(whole)

    def _seen_slopes(self, place: Array) -> Seen:
        """Forward differences, backward at an upper limit. Raises BadInput, NotReached."""
        both = forward_slopes(lambda there: np.concatenate(self._seen(there)), place, self._limits[1], STEP)
        return both[: self._first - 1], both[self._first - 1 :]


def inverse(slopes: Array) -> tuple[Array, bool]:
    """(J^T J)^-1, and whether the coordinates can be told apart; NaN where they cannot."""
    size = slopes.shape[1]
    if not size:
        return np.zeros((0, 0)), True
    _, singular, axes = np.linalg.svd(slopes, full_matrices=False)
    if not singular[0] < INSEPARABLE * singular[-1]:
        return np.full((size, size), np.nan), False
    spread = axes.T / singular
    return spread @ spread.T, True


def _at_bound(problem: FitProblem, name: str, value: float, guess: Values) -> bool:
    """Whether a free parameter lies where the search may go no further; none of a damping is a value like others."""
    low, high = problem.space.limits(name, guess[name])
    low = 0.0 if problem.space.free[name].low == 0.0 and name not in problem.space.bounds else low
    near = AT_BOUND * (problem.measured.duration if name == TOUCH else abs(value))
    return min(value - low, high - value) <= near


def _parameter_warnings(
    problem: FitProblem, parameters: Mapping[str, Estimate], guess: Values, unfelt: Set[str]
) -> Iterator[str]:
    for name, estimate in parameters.items():
        if name in unfelt:
            yield f"{name} does not change the force around {estimate.value:.6g}: the curve does not tell it"
        elif _at_bound(problem, name, estimate.value, guess):
            place = f"{estimate.value:.6g} {estimate.unit}".rstrip()
            own = name in problem.space.bounds
            ran = "is at its bound" if own else "ran into the end of its search"
            yield f"{name} {ran}, {place}: it has no interval{'' if own else ', and the curve does not tell it'}"
        elif estimate.low is None and estimate.high is None:
            yield f"{name} has no interval: the curve hardly tells it"
        elif side := open_side(estimate.low, estimate.high):
            yield f"the interval of {name} is open {side}: no value there is excluded"
        elif estimate.low is not None and estimate.low <= problem.space.free[name].low:
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
