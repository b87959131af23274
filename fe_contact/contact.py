"""The one contact problem: find the pressure that keeps the gap open, by a semismooth Newton method.

With the free overlap ``g`` (interpenetration the surfaces would have without new pressure) at the
quadrature points, the condensed stiffness ``S``, the trace ``T`` and the weights ``W``, the penalised
displacement ``x`` and the striker's own retreat ``y`` minimise the strictly convex, piecewise quadratic energy

    J = x^T S x / 2 + y^2 / (2 yielding) + penalty/2 sum W max(g - T x - y, 0)^2 ,

    pressure = penalty max(g - T x - y, 0) ,    y = yielding sum W pressure .

Newton's step solves with the points now in contact. On a mesh that breathes with the contact these are the same
few sets again and again, so that the answer to every set is kept and a step is two matrix-vector products. A
line search on ``J`` makes it converge from anywhere; an exhausted budget is reported, never returned as a number.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt
from scipy.linalg.lapack import dposv

from fe_contact.forms import Array

MAX_ITERATIONS = 60
UNGUARDED = 4  # iterations that nearly always suffice, and need no line search
ENERGY_ROUNDING = 1e-15  # a change of the energy below this share is rounding
SETS_KEPT = 256  # sets of touching points whose answer is kept

Motion = tuple[Array, float]  # displacement of the surface, (n,), and retreat of the striker


@dataclass(frozen=True, eq=False)
class PressedSurface:
    """What contact knows of a body: condensed stiffness (n, n), trace (q, n), weights (q,)."""

    stiffness: Array
    trace: Array
    weights: Array


@dataclass(frozen=True)
class ContactProblem:
    """A surface, its free overlap (q,), the penalty stiffness, and the striker's retreat per force, 0 held fixed."""

    surface: PressedSurface
    overlap: Array
    penalty: float
    yielding: float = 0.0

    def gap(self, displacement: Array, retreat: float = 0.0) -> Array:
        """Overlap left at the points, (q,), positive where they press."""
        left: Array = self.overlap - self.surface.trace @ displacement
        if retreat:
            left -= retreat
        return left

    def energy(self, displacement: Array, retreat: float = 0.0) -> float:
        """J of the module's docstring."""
        pressed = np.maximum(self.gap(displacement, retreat), 0.0)
        strain = displacement @ (self.surface.stiffness @ displacement)
        striker = retreat**2 / self.yielding if retreat else 0.0
        return 0.5 * float(strain + striker + self.penalty * (self.surface.weights @ pressed**2))


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
        touching = self.signed_pressure > 0.0
        last = len(touching) - 1 - int(touching[::-1].argmax())
        if not touching[last]:
            return 0.0
        if last + 1 == points.size:
            return np.inf
        inside, outside = self.signed_pressure[last : last + 2].tolist()
        return float(points[last] + (points[last + 1] - points[last]) * inside / (inside - outside))


def solve(problem: ContactProblem, touching: npt.NDArray[np.bool_]) -> ContactSolution:
    """Solve from a first guess of the points in contact, shape (q,)."""
    before: Motion | None = None
    held = touching.tobytes()
    for iteration in range(1, MAX_ITERATIONS + 1):
        point, gap = _newton_point(problem, _held(problem.surface, problem.penalty, held))
        found = (gap > 0.0).tobytes()
        if found == held:
            return ContactSolution(point[0], problem.penalty * gap, iteration, True)
        if before is not None:
            point, still = _descended(problem, before, point)
            gap = problem.gap(*point)
            if still:
                return ContactSolution(point[0], problem.penalty * gap, iteration, True)
            found = (gap > 0.0).tobytes()
        if iteration >= UNGUARDED:
            before = point
        held = found
    return ContactSolution(point[0], problem.penalty * gap, MAX_ITERATIONS, False)


@dataclass(frozen=True, eq=False)
class _Held:
    """Answer of a surface whose touching points are held to be those of a set.

    ``displacement`` (n, q) per free overlap and fixed striker; ``lifted`` (n,) per unit overlap everywhere, with
    ``left`` (q,) of it and the force ``stiffness``; ``springs`` (q,) force per overlap left at each point.
    """

    displacement: Array
    lifted: Array
    left: Array
    stiffness: float
    springs: Array


@lru_cache(maxsize=SETS_KEPT)
def _held(surface: PressedSurface, penalty: float, touching: bytes) -> _Held:
    springs = penalty * surface.weights * np.frombuffer(touching, bool)
    weighted = surface.trace.T * springs
    _, displacement, failure = dposv(surface.stiffness + weighted @ surface.trace, weighted)
    if failure:
        raise FloatingPointError("the condensed stiffness lost its positive definiteness")
    lifted = displacement.sum(axis=1)
    left = 1.0 - surface.trace @ lifted
    return _Held(np.ascontiguousarray(displacement), lifted, left, float(springs @ left), springs)


def _newton_point(problem: ContactProblem, held: _Held) -> tuple[Motion, Array]:
    """Minimum of the energy with the set of touching points held fixed: displacement, retreat; the gap there."""
    displacement = held.displacement @ problem.overlap
    gap = problem.gap(displacement)
    if problem.yielding == 0.0:
        return (displacement, 0.0), gap
    force = float(held.springs @ gap) / (1.0 + problem.yielding * held.stiffness)
    retreat = problem.yielding * force
    return (displacement - retreat * held.lifted, retreat), gap - retreat * held.left


def _descended(problem: ContactProblem, start: Motion, end: Motion) -> tuple[Motion, bool]:
    """The end, or the nearest point towards it of less energy than the start; whether the energy stands still."""
    energy, lowest = problem.energy(*start), problem.energy(*end)
    if lowest > energy * (1 + ENERGY_ROUNDING):
        end, lowest = _line_search(problem, start, end, energy)
    return end, abs(energy - lowest) <= ENERGY_ROUNDING * abs(lowest)


def _line_search(problem: ContactProblem, start: Motion, end: Motion, energy: float) -> tuple[Motion, float]:
    """Halve the step until the energy falls; Newton's direction is one of descent."""
    share = 0.5
    while share > 1e-10:
        trial = (start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1]))
        reached = problem.energy(*trial)
        if reached < energy:
            return trial, reached
        share /= 2
    return start, energy
