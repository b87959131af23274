"""The approach, from touch to the turn; the contact radius grows, and every law with memory agrees on it.

It is followed over r = sqrt(t): depth, load and memories are smooth in r at touch, and not in t.

Over a piece of the motion under F = int E(t-s) dy(s) the acceleration is a polynomial through the nodes, found by
Newton. Velocity and depth are its integrals, and each memory solves z = z0 + y - y0 - (1/tau) int z dt, which is
linear: z = (1 + W/tau)^-1 (z0 + y - y0).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from lumped.errors import BadInput, NotReached
from lumped.numbers import Array
from lumped.result.history import AT_REST
from lumped.solvers.hereditary.march import HereditaryMarch, HereditaryPiece, Settings, Stretch
from lumped.solvers.hereditary.path import Path
from lumped.solvers.hereditary.problem import Hereditary
from lumped.solvers.radau import Nodes

NEWTON_STEPS = 14  # work: of one piece of the approach, more is no convergence
# Newton's last correction, relative: what is left after it is its square, or as many times less as its square is less
# than that of the one before. At rest, where accelerations are rounding, the square of this share of gravity and depth.
CONVERGED, DIVERGED = 1e-6, 1e100
DEPTH, VELOCITY, WORK, FORCE, MEMORIES = range(5)  # rows of the state
# A velocity of AT_REST is rest only if the striker would take longer than this share of the time so far to
# stop.
SLOW = 1e-3
# The first piece is this share of the root of the stiffest contact time.
FIRST = 0.4
# A force that the accuracy is counted in at least, in units of the problem, whose own is about one: where a load starts
# like depth over its logarithm, no first piece however short is smooth on its own scale.
FAINT = 1e-3
# Where the force rises steeply the velocity is taken as that of touch, up to this share of the stiffest contact time.
TOUCH = 1e-12


@dataclass(frozen=True, eq=False)
class PieceMotion:
    """Times since the start of the piece at its nodes, (N,), and `weights`, (N, N), of integrals over time."""

    problem: Hereditary
    elapsed: Array
    weights: Array

    @classmethod
    def over_root(cls, problem: Hereditary, table: Nodes, root: float, length: float) -> PieceMotion:
        """The piece from `root` over this length in r = sqrt(t)."""
        step = length * table.points
        return cls(problem, step * (2.0 * root + step), 2.0 * length * table.once * (root + step))

    @classmethod
    def to_end(cls, problem: Hereditary, table: Nodes, duration: float) -> PieceMotion:
        """The piece of this duration in the root of the time left: there contact closes smoothly."""
        left = 1.0 - table.points
        return cls(problem, duration * (1.0 - left * left), 2.0 * duration * table.once * left)

    def piece(self, state: Array, guess: float | Array) -> HereditaryPiece | None:
        """The piece from a state, (4 + K,), the acceleration guessed; None where Newton's steps fail."""
        problem, weights = self.problem, self.weights
        modulus = problem.modulus
        # (1 + W/tau_k)^-1, shape (K, N, N): the rise of a memory by the rise of what it remembers.
        eye = _unit_matrix(self.elapsed.size)
        answers = np.asarray(np.linalg.inv(eye + weights * problem.rates[:, None, None]), dtype=float)
        response = (problem.stiffnesses @ answers.reshape(-1, eye.size)).reshape(eye.shape) + modulus.equilibrium * eye
        left = (problem.stiffnesses * state[4:]) @ answers.sum(axis=2)
        twice, coasted = weights @ weights, state[0] + state[1] * self.elapsed
        a, before = np.full(self.elapsed.size, guess), 0.0
        for step in range(1, NEWTON_STEPS + 1):
            depth = coasted + twice @ a
            load, slopes = problem.loads(np.concatenate([state[:1], depth]))
            rise, slope = load[1:] - load[0], slopes[1:]
            force = response @ rise + modulus.equilibrium * load[0] + left
            matrix = (response * slope) @ twice
            if modulus.viscosity:
                velocity, bend = state[1] + weights @ a, problem.bend(depth, slope)
                force += modulus.viscosity * slope * velocity
                matrix += modulus.viscosity * (slope[:, None] * weights + (bend * velocity)[:, None] * twice)
            change = np.linalg.solve(matrix + eye, problem.gravity - force - a)
            a += change
            size = math.sqrt(change @ change)
            if not size < DIVERGED:
                return None
            allowed = CONVERGED**2 * math.sqrt(a @ a)
            rests = size <= CONVERGED**2 * abs(problem.gravity) and np.all(
                np.abs(twice @ change) <= CONVERGED**2 * np.abs(depth)
            )
            if rests or size * CONVERGED <= allowed or size**3 <= allowed * before**2:
                # Not gravity less the acceleration: under much of it a faint force would be its rounding.
                force, rise = force + matrix @ change, rise + slope * (twice @ change)
                return HereditaryPiece(self._values(state, a, force, rise, answers), step)
            before = size
        return None

    def _values(self, state: Array, a: Array, force: Array, rise: Array, answers: Array) -> Array:
        """The fields at the first place and the nodes; `rise` is by how much the load has grown."""
        weights = self.weights
        velocity = state[1] + weights @ a
        depth = state[0] + weights @ velocity
        values = np.empty((state.size, a.size + 1))
        values[:, 0] = state
        values[0, 1:], values[1, 1:], values[3, 1:] = depth, velocity, force
        values[2, 1:] = state[2] + weights @ (force * velocity)
        if self.problem.terms:
            values[4:, 1:] = (answers @ (state[4:, None] + rise)[..., None])[..., 0]
        return values


@cache
def _unit_matrix(count: int) -> Array:
    return np.eye(count)


@dataclass(frozen=True)
class Approach:
    """Its path over r; whether the striker turned at its end, or came to rest; Newton steps and largest force."""

    path: Path
    turned: bool
    rests: bool
    steps: int
    largest: float

    @property
    def end(self) -> float:
        """The time where it ended."""
        return self.path.end**2


def follow(
    problem: Hereditary,
    span: tuple[float, float],
    state: Array,
    first: float,
    over: Callable[[Array], bool],
    settings: Settings,
    largest: float = 0.0,
    before: Path | None = None,
) -> HereditaryMarch:
    """March over a span of r from a state until `over`; `first` is the length to begin with. Raises NotReached."""
    beyond: BadInput | NotReached | None = None

    def attempt(root: float, length: float, state: Array) -> HereditaryPiece | None:
        """A long piece may try depths beyond the load curve that the motion never sees: then a shorter one."""
        nonlocal beyond
        motion, found = PieceMotion.over_root(problem, settings.table, root, length), None
        try:
            if before is not None:
                force = before.value(FORCE, root + length * settings.table.points)
                found = motion.piece(state, problem.gravity - force)
            return found or motion.piece(state, problem.gravity - float(state[FORCE]))
        except (BadInput, NotReached) as failure:
            beyond = failure
            return None

    found = Stretch(attempt, FORCE, over).march(span, state, first, settings, largest, before)
    if found.stuck:
        where = f"the motion could not be followed beyond {found.path.end**2 * problem.scales.time:.6g} s"
        raise beyond or NotReached(where)
    return found


def approach(problem: Hereditary, end_time: float, settings: Settings, before: Approach | None = None) -> Approach:
    """Follow the motion to its turn, to rest, or to `end_time`, in units of the problem. Raises NotReached.

    `before` is the same approach found with fewer nodes: its pieces are kept, and it is where Newton starts.
    """
    known = None if before is None else before.path
    slow = AT_REST if problem.modulus.relaxed == 0.0 and problem.gravity == 0.0 else 0.0
    found, end = _to_velocity(problem, end_time, slow, settings, known)
    if slow and found.over:
        force = float(found.path.state(end)[FORCE])
        if slow > SLOW * force * end**2:
            return Approach(found.path.until(end), False, True, found.steps, found.largest)
        found, end = _to_velocity(problem, end_time, 0.0, settings, known)
    return Approach(found.path.until(end), found.over, False, found.steps, found.largest)


def _to_velocity(
    problem: Hereditary, end_time: float, slow: float, settings: Settings, before: Path | None
) -> tuple[HereditaryMarch, float]:
    """The march until the velocity has fallen to `slow`, and the place where it has."""

    def over(values: Array) -> bool:
        return bool(values[VELOCITY].min() <= slow)

    touch = _touch(problem, settings) if problem.rises_steeply else None
    begin = touch.end if touch else 0.0
    first = 3.0 * begin or FIRST * problem.shortest**0.5
    start = problem.early(np.array([begin**2]))[:, 0]
    found = follow(problem, (begin, end_time**0.5), start, first, over, settings, FAINT, before)
    if touch:
        found = replace(found, path=touch.joined(found.path))
    if not found.over:
        return found, found.path.end
    place = found.path.fall(VELOCITY, slow)
    return found, found.path.end if place is None else place


def _touch(problem: Hereditary, settings: Settings) -> Path:
    """The very first piece, at the velocity of touch."""
    end = (TOUCH * problem.shortest) ** 0.5
    return Path.of([0.0, end], [problem.early((end * np.append(0.0, settings.table.points)) ** 2)])
