"""The one contact problem: find the pressure that keeps the gap open, by a semismooth Newton method.

With the free overlap ``g`` (interpenetration the surfaces would have without new pressure) at the
quadrature points, the condensed stiffness ``S``, the trace ``T`` and the weights ``W``, the penalised
displacement ``x`` and the striker's own retreat ``y`` minimise the strictly convex, piecewise quadratic energy

    J = x^T S x / 2 + y^2 / (2 yielding) + penalty/2 sum W max(g - T x - y, 0)^2 ,

    pressure = penalty max(g - T x - y, 0) ,    y = yielding sum W pressure .

Newton's step solves with the points now in contact. On a mesh that follows the contact these are the same
few sets again and again, so that the answer to every set is kept and a step is one matrix-vector product. A
line search on ``J`` makes it converge from anywhere; an exhausted budget is reported, never returned as a number.
Where the set stands still the answer must still balance: a penalty beyond all digits, or a line search that ends in
rounding, is reported too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
import numpy.typing as npt
import scipy.sparse as sparse
from scipy.linalg.lapack import dgetrf, dgetrs, dpotrf, dpotrs

from fe_contact.assembly.cache import Store
from fe_contact.assembly.forms import Array, Matrix

INDEPENDENT = 1e-10  # of the largest: less than this is a sum of the others, as a rigid striker's unit displacement is
MAX_ITERATIONS = 60  # work: sets of touching points tried, more is no convergence
UNGUARDED = 8  # iterations that nearly always suffice, and need no line search
TRUSTED = 1e-3  # of the following: where a striker moved by one leaves no more, other overlaps do not either
RESIDUAL = 1e-6  # of the largest overlap that presses: the answer is exact for one which differs by less
ENERGY_ROUNDING = 1e-15  # a change of the energy below this share is rounding
SHORTEST = 1e-10  # share of a step below which the energy stands still
ROOM = 32e6  # bytes of answers to sets of touching points that are kept: some 300 of them

Touching = npt.NDArray[np.bool_]

_ANSWERS = Store(ROOM)


@dataclass(frozen=True, eq=False)
class PressedSurface:
    """What contact knows of a body: condensed stiffness (n, n), trace (q, n), weights (q,).

    ``recurring``: whether the same sets of points touch again and again, so that their answers are worth keeping.
    ``compliance`` (q, q), displacement at the points under unit forces there, of surfaces with more nodes than points.
    ``carriers`` (q, m): shape functions of a pressure that both of two bodies can follow; of one body, those it has.
    """

    stiffness: Array
    trace: Array
    weights: Array
    recurring: bool = True
    compliance: Array | None = None
    carriers: Array | None = None

    def held(self, springs: Array) -> Array:
        """Stiffness with springs (q,) at the points, (n, n), in the order of columns that LAPACK needs."""
        places, squares = self._squares
        held = self.stiffness.copy()
        held.ravel()[places] += squares @ springs
        return held.T

    def gaps(self, springs: Array) -> Callable[[Array], Array]:
        """What is left of any overlaps (q, k) where springs (q,) stand between the surfaces."""
        if self.compliance is not None:
            return _between_points(self.compliance, springs)
        solve, (seen, pushed) = factorised(self.held(springs)), self._facets
        return lambda overlaps: np.asarray(overlaps - seen @ solve(pushed @ (springs[:, None] * overlaps)))

    def work(self, forces: Array) -> float:
        """Of forces (q,) at the points on the displacement that they cause."""
        return float(forces @ self.displaced(forces))

    def displaced(self, forces: Array) -> Array:
        """The points (q,) under forces (q,) at them."""
        if self.compliance is not None:
            return np.asarray(self.compliance @ forces)
        seen, pushed = self._facets
        return np.asarray(seen @ dgetrs(*self._factors, pushed @ forces)[0])

    def in_shapes(self, pressure: Array) -> Array:
        """The nearest to a pressure (q,) that is a combination of the surface's shape functions."""
        directions = self._directions
        root = np.sqrt(self.weights)
        return np.asarray(directions @ (directions.T @ (root * pressure))) / root

    def stiffened(self, stiffness: Array) -> PressedSurface:
        """The same points on another stiffness; what is known of the points alone is shared."""
        other = replace(self, stiffness=stiffness)
        vars(other).update(_facets=self._facets, _squares=self._squares, _directions=self._directions)
        return other

    @cached_property
    def _factors(self) -> tuple[Array, npt.NDArray[np.int32]]:
        """Of the stiffness alone, with their pivots."""
        return dgetrf(self.stiffness)[:2]

    @cached_property
    def _directions(self) -> Array:
        """The shape functions times the root of the weights, made orthonormal, (q, rank)."""
        shapes = self.trace if self.carriers is None else self.carriers
        found, sizes, _ = np.linalg.svd(np.sqrt(self.weights)[:, None] * shapes, full_matrices=False)
        return np.asarray(found[:, sizes > INDEPENDENT * sizes[0]])

    @cached_property
    def _facets(self) -> tuple[Matrix, Matrix]:
        """The trace and its transpose, sparse, by rows: a point sees the nodes of its facet alone."""
        seen = sparse.csr_matrix(self.trace)
        return seen, seen.T.tocsr()

    @cached_property
    def _squares(self) -> tuple[npt.NDArray[np.intp], Matrix]:
        """Every point's trace times itself as a column, sparse (m, q), and of n n places those m that are not zero."""
        points, nodes = self.trace.shape
        rows, _ = self._facets
        seen = [rows.indices[start:end] for start, end in zip(rows.indptr, rows.indptr[1:], strict=False)]
        pairs = [(ours[:, None] * nodes + ours).ravel() for ours in seen]
        values = [np.outer(own := self.trace[i, ours], own).ravel() for i, ours in enumerate(seen)]
        columns = np.repeat(np.arange(points), [len(pair) for pair in pairs])
        places, row = np.unique(np.concatenate(pairs), return_inverse=True)
        return places, sparse.csr_matrix((np.concatenate(values), (row, columns)), shape=(places.size, points))


def _between_points(compliance: Array, springs: Array) -> Callable[[Array], Array]:
    """By the forces of the springs: (1/k + C) forces = overlap where they stand, multiplied by the root of k."""
    acting = _those(springs)
    root = np.sqrt(springs[acting])
    if not root.size:
        return lambda overlaps: overlaps
    system = root[:, None] * compliance[acting][:, acting] * root
    system[np.diag_indices(root.size)] += 1.0
    solve = factorised(system.T)

    def left(overlaps: Array) -> Array:
        scaled = solve(root[:, None] * overlaps[acting])
        gaps = np.asarray(overlaps - compliance[:, acting] @ (root[:, None] * scaled))
        gaps[acting] = scaled / root[:, None]
        return gaps

    return left


def _those(springs: Array) -> slice | npt.NDArray[np.intp]:
    """Where springs stand: as a rule without a hole, and then nothing has to be copied."""
    acting = np.flatnonzero(springs)
    whole = acting.size and acting.size == acting[-1] - acting[0] + 1
    return slice(acting[0], acting[-1] + 1) if whole else acting


def factorised(matrix: Array) -> Callable[[Array], Array]:
    """Solves with a symmetric positive definite matrix, which its factors overwrite. Raises FloatingPointError."""
    factor, failure = dpotrf(matrix, lower=True, overwrite_a=True, clean=False)  # OpenBLAS takes a third more for upper
    if failure:
        raise FloatingPointError("the condensed stiffness lost its positive definiteness")
    return lambda right: np.asarray(dpotrs(factor, right, lower=True)[0])


@dataclass(frozen=True)
class ContactProblem:
    """A surface, its free overlap (q,), the penalty stiffness, and the striker's retreat per force, 0 held fixed.

    On a unit mesh overlap and retreat count times the modulus, and the penalty in units of it over the contact radius.
    ``yielding`` (q,): per force at each point, on surfaces that do not recur; so nearly alike where points touch that
    the energy's slope is Newton's residual all the same.
    """

    surface: PressedSurface
    overlap: Array
    penalty: float
    yielding: float | Array = 0.0


@dataclass(frozen=True)
class ContactSolution:
    """Signed pressure (q,) (negative where open), Newton iterations, convergence.

    ``sets``: touching points (q,) of every contact problem on the way, first guesses for a problem much like it.
    """

    signed_pressure: Array
    iterations: int
    converged: bool
    sets: tuple[Touching, ...]

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


def solve(problem: ContactProblem, touching: Touching) -> ContactSolution:
    """Solve from a first guess of the points in contact, shape (q,)."""
    before: _Point | None = None
    held, guarded = touching.tobytes(), UNGUARDED
    for iteration in range(1, MAX_ITERATIONS + 1):
        answer = _answer(problem.surface, problem.penalty, held) if problem.surface.recurring else _once(problem, held)
        gap, retreat = answer.gap(problem)
        found = (gap > 0.0).tobytes()
        if found == held:
            settled = answer.trusted or _balances(problem, gap)
            return _solution(problem, gap, iteration, settled)
        if iteration >= guarded:
            point = _Point(answer.springs * gap, retreat, gap)
            if before is not None:
                point, still = _descended(problem, before, point)
                gap, found = point.gap, (point.gap > 0.0).tobytes()
                if still:
                    if _balances(problem, gap):
                        return _solution(problem, gap, iteration, True)
                    guarded = iteration + UNGUARDED  # rounding of the energy hides the way: on without it
            before = None if iteration < guarded else point
        held = found
    return _solution(problem, gap, MAX_ITERATIONS, False)


def count(touching: Touching) -> int:
    """How many points touch."""
    return int(np.count_nonzero(touching))


def moved(touching: Touching, by: int) -> Touching:
    """As many points and ``by`` more without a hole: outwards from the axis, on both sides of what spares it."""
    if not by:
        return touching
    start = 0 if touching[0] else max(int(touching.argmax()) - by // 2, 0)
    distance = np.arange(touching.size) - start
    return (distance >= 0) & (distance < count(touching) + by)


def _solution(problem: ContactProblem, gap: Array, iterations: int, settled: bool) -> ContactSolution:
    return ContactSolution(problem.penalty * gap, iterations, settled, (gap > 0.0,))


def _balances(problem: ContactProblem, gap: Array) -> bool:
    """Whether the gap is what its own pressure leaves of the overlap, to a share of the largest that presses."""
    touching = gap > 0.0
    forces = problem.penalty * problem.surface.weights * (gap * touching)
    yielding = problem.yielding
    retreat = yielding * forces.sum() if isinstance(yielding, float) else yielding @ forces
    off = problem.overlap - problem.surface.displaced(forces) - retreat - gap
    return bool(np.abs(off).max() <= RESIDUAL * np.abs(problem.overlap * touching).max())


@dataclass(frozen=True, eq=False)
class _Answer:
    """Minimum of the energy with the set of touching points held fixed, for every overlap.

    ``left`` (q, q): gap per free overlap, positive where points press, under a fixed striker; ``lifted`` (q,) its
    row sums, the gap of a striker moved by one; ``springs`` (q,) force per gap; ``stiffness`` force per striker's
    motion; ``trusted``: that gap balances so well that rounding is no question for any other.
    """

    left: Array
    lifted: Array
    springs: Array
    stiffness: float
    trusted: bool

    def gap(self, problem: ContactProblem) -> tuple[Array, float]:
        """Gap (q,) and the striker's retreat."""
        gap: Array = self.left @ problem.overlap
        yielding = float(problem.yielding)
        if yielding == 0.0:
            return gap, 0.0
        force = float(self.springs @ gap) / (1.0 + yielding * self.stiffness)
        retreat = yielding * force
        gap -= retreat * self.lifted
        return gap, retreat


@dataclass(frozen=True, eq=False)
class _Once:
    """The same for one overlap: gap (q,) and retreat."""

    left: Array
    retreat: float
    springs: Array
    trusted: bool = False

    def gap(self, problem: ContactProblem) -> tuple[Array, float]:
        """Gap (q,) and the striker's retreat."""
        return self.left, self.retreat


def _once(problem: ContactProblem, touching: bytes) -> _Once:
    springs, left = _pressed(problem.surface, problem.penalty, touching)
    given = problem.yielding * springs
    if not given.any():
        return _Once(left(problem.overlap[:, None])[:, 0], 0.0, springs)
    gap, lifted = left(np.stack([problem.overlap, np.ones_like(springs)], axis=1)).T
    retreat = float(given @ gap) / (1.0 + float(given @ lifted))
    return _Once(gap - retreat * lifted, retreat, springs)


@lru_cache(maxsize=1)  # where a step's second solve begins its first one ended
def _pressed(surface: PressedSurface, penalty: float, touching: bytes) -> tuple[Array, Callable[[Array], Array]]:
    """Springs (q,), and what they leave of any overlaps (q, k)."""
    springs = penalty * surface.weights * np.frombuffer(touching, bool)
    return springs, surface.gaps(springs)


def _answer(surface: PressedSurface, penalty: float, touching: bytes) -> _Answer:
    """The one at hand, or a new one."""
    return _ANSWERS.find(
        (surface, penalty, touching), lambda: _answered(surface, penalty, touching), lambda answer: answer.left.nbytes
    )


def _answered(surface: PressedSurface, penalty: float, touching: bytes) -> _Answer:
    springs = penalty * surface.weights * np.frombuffer(touching, bool)
    left = np.eye(len(springs)) - surface.trace @ factorised(surface.held(springs))(surface.trace.T * springs)
    lifted = left.sum(axis=1)
    off = np.abs(1.0 - surface.displaced(springs * lifted) - lifted).max()
    return _Answer(left, lifted, springs, float(springs @ lifted), bool(off <= TRUSTED * RESIDUAL))


# --- the line search: a step of Newton's method that does not lessen the energy is shortened


@dataclass(frozen=True, eq=False)
class _Point:
    """A place between Newton's points: forces (q,) that displace the surface, striker's retreat, gap (q,)."""

    forces: Array
    retreat: float
    gap: Array

    def towards(self, other: _Point, share: float) -> _Point:
        """The point at a share of the way to another."""
        return _Point(
            self.forces + share * (other.forces - self.forces),
            self.retreat + share * (other.retreat - self.retreat),
            self.gap + share * (other.gap - self.gap),
        )

    def energy(self, problem: ContactProblem) -> float:
        """J of the module's formula."""
        strain = problem.surface.work(self.forces)
        striker = self.retreat * float(self.forces.sum())
        pressed = problem.surface.weights @ np.maximum(self.gap, 0.0) ** 2
        return 0.5 * (strain + striker + problem.penalty * float(pressed))


def _descended(problem: ContactProblem, start: _Point, end: _Point) -> tuple[_Point, bool]:
    """The end, or the nearest point towards it of less energy than the start; whether the energy stands still."""
    energy = start.energy(problem)
    point, lowest, share = end, end.energy(problem), 1.0
    while lowest > energy * (1 + ENERGY_ROUNDING):
        share /= 2
        if share < SHORTEST:
            return start, True
        point = start.towards(end, share)
        lowest = point.energy(problem)
    return point, abs(energy - lowest) <= ENERGY_ROUNDING * abs(lowest)
