"""How well a fit is known: covariance by the linearized least squares, intervals, and what to be warned of."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Set
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from lumped.errors import BadInput, NotReached
from lumped.fit.problem import FitProblem
from lumped.fit.record import Estimate
from lumped.fit.space import TOUCH
from lumped.schema.keys import Number

Array = NDArray[np.float64]
CONFIDENCE = 0.95
# Steps of the differences, of the value or of this share of its guess, whichever is larger: a damping near zero has
# no size of its own.
STEP, LEAST_SHARE = 1e-3, 0.01
# Residuals per relative change: below the first nothing is felt, above the second ratio two are one.
UNFELT, ALIKE = 1e-9, 1e8
CORRELATED = 0.99
SYSTEMATIC = "neighbouring residuals are alike: what is left is the law's own error, and no interval holds it"
AT_BOUND = 1e-6
FORCE = Number(-math.inf, math.inf, "N")


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
    parameters = {
        name: _estimate(values[name], math.nan if name in unfelt else width, problem.space.free[name])
        for name, width in zip(names, widths.tolist(), strict=False)
    }
    covariance = spread[:-1, :-1]
    warnings = [
        *_parameter_warnings(problem, parameters, guess, unfelt),
        *_pair_warnings(problem, covariance, told),
        *((SYSTEMATIC,) if problem.measured.systematic(error) else ()),
    ]
    return Certainty(covariance, parameters, depth, _estimate(force, float(widths[-1]), FORCE), tuple(warnings))


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


def _estimate(value: float, width: float, key: Number) -> Estimate:
    """A value with its interval, cut where the parameter ends; none of a width that is not known."""
    if not math.isfinite(width):
        return Estimate(value, None, None, key.unit)
    return Estimate(value, max(value - width, key.low), min(value + width, key.high), key.unit)


def _parameter_warnings(
    problem: FitProblem, parameters: Mapping[str, Estimate], guess: Mapping[str, float], unfelt: Set[str]
) -> Iterator[str]:
    for name, estimate in parameters.items():
        low, high = problem.space.limits(name, guess[name])
        near = AT_BOUND * (problem.measured.duration if name == TOUCH else abs(estimate.value))
        if name in unfelt:
            yield f"{name} does not change the force around {estimate.value:.6g}: the curve does not tell it"
        elif min(estimate.value - low, high - estimate.value) <= near:
            yield f"{name} is at its bound, {estimate.value:.6g}: its interval is not one"
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
