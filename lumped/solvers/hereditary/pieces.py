"""Pieces of the motion under F = int E(t-s) dy(s), of many impacts at once.

Over a piece the acceleration is a polynomial through the nodes, found by Newton. Velocity and depth are its integrals,
and each memory solves z = z0 + y - y0 - (1/tau) int z dt, which is linear: z = (1 + W/tau)^-1 (z0 + y - y0).

An impact is followed by a generator that asks for one piece after the other. The arrays of one piece are so small that
numpy's calls take longer than their sums: of impacts followed together, all pieces of one kind are solved in one array,
its first axis their number. No sum runs over that axis, so that an answer is the same to the bit in any company.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Sequence
from dataclasses import dataclass, fields
from functools import cache
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from lumped.errors import BadInput, FeContactError, NotReached
from lumped.numbers import Array
from lumped.solvers.hereditary.path import Path, values_of
from lumped.solvers.hereditary.problem import Hereditary, Problems
from lumped.solvers.radau import Nodes

T = TypeVar("T")
NEWTON_STEPS = 14  # work: of one piece, more is no convergence
# Newton's last correction, relative: what is left after it is its square, or as many times less as its square is less
# than that of the one before. At rest, where accelerations are rounding, the square of this share of gravity and depth.
CONVERGED, DIVERGED = 1e-6, 1e100
DEPTH, VELOCITY, WORK, FORCE, MEMORIES = range(5)  # rows of the state


class HereditaryPiece(NamedTuple):
    """A solved piece: fields at its first place and its nodes, shape (fields, N+1); Newton steps it took."""

    values: Array
    steps: int


# Of lengths (B, 1), and roots (B, 1) where they begin: times since the start at the nodes, and d time/d place, (B, N).
Clock = Callable[[Nodes, Array, Array], tuple[Array, Array]]


def over_root(table: Nodes, root: Array, length: Array) -> tuple[Array, Array]:
    """Pieces over this length in r = sqrt(t)."""
    step = length * table.points
    return step * (2.0 * root + step), 2.0 * length * (root + step)


def to_end(table: Nodes, root: Array, duration: Array) -> tuple[Array, Array]:
    """Pieces of this duration, in time, over the root of the time left: there contact closes smoothly."""
    left = 1.0 - table.points
    return duration * (1.0 - left * left), 2.0 * duration * left


class PieceAsked(NamedTuple):
    """A piece from a state, (4 + K,), the force guessed as that of a path `before` at places (N,), or as it is now."""

    problem: Hereditary
    table: Nodes
    clock: Clock
    root: float
    length: float
    state: Array
    before: Path | None = None
    places: Array | None = None

    @property
    def kind(self) -> tuple[object, ...]:
        """What pieces share that are solved together."""
        problem, known = self.problem, self.before and self.before.coefficients.shape[2]
        driven = problem.modulus.viscosity > 0.0, problem.gravity != 0.0
        return self.clock, self.table.points.size, known, problem.terms, *driven


# What asks for pieces until it has its answer; it is sent a piece, or None where Newton's steps fail.
Followed = Generator[PieceAsked, HereditaryPiece | None, T]
Told = HereditaryPiece | FeContactError | None


def alone(impact: Followed[T]) -> T:
    """What follows from its pieces. Raises what it raises."""
    return together([impact])[0]


def together(impacts: Iterable[Followed[T]]) -> list[T]:
    """What follows from the pieces of each. Raises what one of them raises."""
    running, ended = dict(enumerate(impacts)), dict[int, T]()
    told: dict[int, Told] = dict.fromkeys(running)
    while told:
        kinds = dict[tuple[object, ...], dict[int, PieceAsked]]()
        for i, answer in told.items():
            try:
                asked = running[i].throw(answer) if isinstance(answer, FeContactError) else running[i].send(answer)
                kinds.setdefault(asked.kind, {})[i] = asked
            except StopIteration as done:
                ended[i] = done.value
        told = {i: one for same in kinds.values() for i, one in zip(same, _told([*same.values()]), strict=True)}
    return [ended[i] for i in running]


def _told(asked: Sequence[PieceAsked]) -> list[Told]:
    """The pieces asked for, all of one kind; what fails with all is asked one by one."""
    try:
        return [*Pieces.of(asked).solved(_guessed(asked))]
    except (BadInput, NotReached) as failure:  # depths beyond a load curve
        return [failure] if len(asked) == 1 else [told for one in asked for told in _told([one])]


def _guessed(asked: Sequence[PieceAsked]) -> Array:
    """The force at the nodes as it is guessed, (B, N)."""
    paths = [one.before for one in asked if one.before]
    if not paths:
        return np.array([[one.state[FORCE]] for one in asked]).repeat(asked[0].table.points.size, axis=1)
    return values_of(FORCE, paths, np.array([one.places for one in asked]))


@dataclass(frozen=True, eq=False)
class Pieces:
    """B pieces with N nodes, of materials with K terms.

    ``weights`` (B, N, N) integrate over time, ``twice`` two times, and ``coasted`` (B, N) are depths without a force.
    ``answers`` are (1 + W/tau_k)^-1, (B, K, N, N): the rise of a memory by the rise of what it remembers. With the
    load's rise ``response`` (B, N, N) gives the force beside what is ``left``, (B, N), of the memories' first values.
    """

    problems: Problems
    state: Array
    weights: Array
    answers: Array
    response: Array
    left: Array
    twice: Array
    coasted: Array

    @classmethod
    def of(cls, asked: Sequence[PieceAsked]) -> Pieces:
        """Those asked for, all of one kind."""
        problems, table = Problems.of([one.problem for one in asked]), asked[0].table
        state = np.array([one.state for one in asked])
        spans = np.array([[one.root, one.length] for one in asked])
        elapsed, pace = asked[0].clock(table, spans[:, :1], spans[:, 1:])
        weights, eye = table.once * pace[:, None, :], _unit_matrix(table.points.size)
        decays = weights[:, None] * problems.rates[:, :, None, None]
        answers = np.asarray(np.linalg.inv(eye + decays), dtype=float)
        stiffnesses = problems.stiffnesses[:, :, None]
        response = np.add.reduce(stiffnesses[..., None] * answers, axis=1) + problems.equilibrium[:, :, None] * eye
        held = stiffnesses * state[:, MEMORIES:, None] * np.add.reduce(answers, axis=3)
        coasted = state[:, :1] + state[:, 1:2] * elapsed
        return cls(problems, state, weights, answers, response, np.add.reduce(held, axis=1), weights @ weights, coasted)

    def solved(self, forces: Array) -> list[HereditaryPiece | None]:
        """Each from a guess of its force, (B, N); None where Newton's steps fail."""
        count, a = len(forces), self.problems.gravity - forces
        found: list[HereditaryPiece | None] = [None] * count
        pieces, which, before = self, np.arange(count), np.zeros(count)
        for step in range(1, NEWTON_STEPS + 1):
            iterate = pieces.iterate(a)
            a = a + iterate.change
            size, allowed = _size(iterate.change), CONVERGED**2 * _size(a)
            going = size < DIVERGED
            done = (size * CONVERGED <= allowed) | (size**3 <= allowed * before**2)
            if pieces.problems.weighty:
                done |= pieces.rests(iterate, size)
            done &= going
            if done.any():
                values = pieces.values(a, iterate)
                for i in np.flatnonzero(done).tolist():
                    found[which[i]] = HereditaryPiece(values[i], step)
            going &= ~done
            if not going.any():
                break
            if not going.all():
                pieces, a, which, size = pieces.chosen(going), a[going], which[going], size[going]
            before = size
        return found

    def iterate(self, a: Array) -> Iterate:
        """What accelerations (B, N) lead to, and Newton's step from there."""
        problems, response = self.problems, self.response
        depth = self.coasted + _times(self.twice, a)
        load, slopes = problems.loads(np.concatenate([self.state[:, :1], depth], axis=1))
        rise, slope = load[:, 1:] - load[:, :1], slopes[:, 1:]
        force = _times(response, rise) + problems.equilibrium * load[:, :1] + self.left
        matrix = (response * slope[:, None]) @ self.twice
        if problems.viscous:
            velocity, viscosity = self.state[:, 1:2] + _times(self.weights, a), problems.viscosity
            bent = (problems.bend(depth, slope) * velocity)[..., None] * self.twice
            force += viscosity * slope * velocity
            matrix += viscosity[..., None] * (slope[..., None] * self.weights + bent)
        lack = problems.gravity - force - a
        change = np.asarray(np.linalg.solve(matrix + _unit_matrix(a.shape[1]), lack[..., None])[..., 0], dtype=float)
        # Not gravity less the acceleration: under much of it a faint force would be its rounding.
        deeper = _times(self.twice, change)
        return Iterate(depth, change, deeper, force + _times(matrix, change), rise + slope * deeper)

    def rests(self, iterate: Iterate, size: Array) -> NDArray[np.bool_]:
        """Where all of it is rounding, (B,)."""
        still = (np.abs(iterate.deeper) <= CONVERGED**2 * np.abs(iterate.depth)).all(axis=1)
        return np.asarray(still & (size <= CONVERGED**2 * np.abs(self.problems.gravity[:, 0])))

    def values(self, a: Array, iterate: Iterate) -> Array:
        """The fields at the first place and the nodes, (B, fields, N + 1)."""
        state, weights = self.state, self.weights
        velocity = state[:, 1:2] + _times(weights, a)
        values = np.empty((*state.shape, a.shape[1] + 1))
        values[:, :, 0] = state
        values[:, DEPTH, 1:] = state[:, :1] + _times(weights, velocity)
        values[:, VELOCITY, 1:], values[:, FORCE, 1:] = velocity, iterate.force
        values[:, WORK, 1:] = state[:, 2:3] + _times(weights, iterate.force * velocity)
        remembered = state[:, MEMORIES:, None] + iterate.rise[:, None]
        values[:, MEMORIES:, 1:] = _times(self.answers, remembered)
        return values

    def chosen(self, which: NDArray[np.bool_]) -> Pieces:
        """Some of them."""
        return Pieces(self.problems.chosen(which), *(getattr(self, one.name)[which] for one in fields(self)[1:]))


class Iterate(NamedTuple):
    """Depths tried, Newton's step of the accelerations, by how much it goes deeper; force and rise of the load then.

    All of shape (B, N).
    """

    depth: Array
    change: Array
    deeper: Array
    force: Array
    rise: Array


def _times(matrices: Array, columns: Array) -> Array:
    """Each of the matrices (..., N, N) on its column (..., N)."""
    found: Array = (matrices @ columns[..., None])[..., 0]
    return found


def _size(rows: Array) -> Array:
    """The norm of each of the rows (B, N)."""
    return np.asarray(np.sqrt(np.add.reduce(rows * rows, axis=1)))


@cache
def _unit_matrix(count: int) -> Array:
    return np.eye(count)
