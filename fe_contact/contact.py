"""The one contact problem: find the pressure that keeps the gap open, by a semismooth Newton method.

With the free overlap ``g`` (interpenetration the surfaces would have without new pressure) at the
quadrature points, the condensed stiffness ``S``, the trace ``T`` and the weights ``W``, the penalised
displacement ``x`` minimises the strictly convex, piecewise quadratic energy

    J(x) = x^T S x / 2 + penalty/2 sum W max(g - T x, 0)^2 ,    pressure = penalty max(g - T x, 0).

Newton's step solves with the points now in contact; a line search on ``J`` makes it converge from
anywhere, and a cycle or an exhausted budget is reported, never returned as a number.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg.lapack import dposv

from fe_contact.forms import Array

MAX_ITERATIONS = 60
ENERGY_ROUNDING = 1e-15  # a change of the energy below this share is rounding


@dataclass(frozen=True)
class ContactProblem:
    """Condensed stiffness (n, n), trace (q, n), weights (q,), free overlap (q,), penalty stiffness."""

    stiffness: Array
    trace: Array
    weights: Array
    overlap: Array
    penalty: float

    def energy(self, displacement: Array) -> float:
        """J(x) of the module's docstring."""
        pressed = np.maximum(self.overlap - self.trace @ displacement, 0.0)
        strain = displacement @ (self.stiffness @ displacement)
        return 0.5 * float(strain + self.penalty * (self.weights @ pressed**2))


@dataclass(frozen=True)
class ContactSolution:
    """Displacement (n,), signed pressure (q,) (negative where open), Newton iterations, convergence."""

    displacement: Array
    signed_pressure: Array
    iterations: int
    converged: bool

    @property
    def pressure(self) -> Array:
        """Contact pressure at the quadrature points, >= 0."""
        return np.maximum(self.signed_pressure, 0.0)

    def edge(self, points: Array) -> float:
        """Radius where the pressure returns to zero: 0 without contact, inf if all points touch."""
        touching = np.flatnonzero(self.signed_pressure > 0.0)
        if touching.size == 0:
            return 0.0
        last = int(touching[-1])
        if last + 1 == points.size:
            return np.inf
        inside, outside = self.signed_pressure[last : last + 2]
        return float(points[last] + (points[last + 1] - points[last]) * inside / (inside - outside))


def solve(problem: ContactProblem, touching: npt.NDArray[np.bool_]) -> ContactSolution:
    """Solve from a first guess of the points in contact, shape (q,)."""
    current: Array | None = None
    energy = np.inf
    for iteration in range(1, MAX_ITERATIONS + 1):
        candidate = _newton_point(problem, touching)
        gap = problem.overlap - problem.trace @ candidate
        if np.array_equal(gap > 0.0, touching):
            return ContactSolution(candidate, problem.penalty * gap, iteration, True)
        lowest = problem.energy(candidate)
        if current is not None and lowest > energy * (1 + ENERGY_ROUNDING):
            candidate, lowest = _line_search(problem, current, candidate, energy)
            gap = problem.overlap - problem.trace @ candidate
        if abs(energy - lowest) <= ENERGY_ROUNDING * abs(lowest):
            return ContactSolution(candidate, problem.penalty * gap, iteration, True)
        current, energy, touching = candidate, lowest, gap > 0.0
    return ContactSolution(candidate, problem.penalty * gap, MAX_ITERATIONS, False)


def _newton_point(problem: ContactProblem, touching: npt.NDArray[np.bool_]) -> Array:
    """Minimum of the energy with the set of touching points held fixed."""
    springs = problem.penalty * problem.weights * touching
    weighted = problem.trace.T * springs
    matrix = problem.stiffness + weighted @ problem.trace
    _, displacement, failure = dposv(matrix, weighted @ problem.overlap)
    if failure:
        raise FloatingPointError("the condensed stiffness lost its positive definiteness")
    return np.asarray(displacement)


def _line_search(problem: ContactProblem, start: Array, end: Array, energy: float) -> tuple[Array, float]:
    """Halve the step until the energy falls; Newton's direction is one of descent."""
    share = 0.5
    while share > 1e-10:
        trial = start + share * (end - start)
        reached = problem.energy(trial)
        if reached < energy:
            return trial, reached
        share /= 2
    return start, energy
