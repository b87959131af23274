"""Ting's rebound: the contact shrinks back over the places that it passed, doi 10.1115/1.3625192.

At time t the contact radius is what it was at an earlier time t1(t), where int_{t1}^t E(t-s) d depth(s) = 0,
and the force is F(t) = int_0^{t1} E(t-s) dy(s). The rebound is followed over s = -sqrt(t1), from the turn to
0, where contact ends: the approach is known at every place, the time is what is sought, and all is smooth.

The depth's memories are split at the turn t_m. With E(t) = sum_j E_j exp(-t/tau_j) + eta delta(t), E_inf among the
E_j with an endless tau_j, Y_j(t1) as below and X_j' = depth' - X_j/tau_j from
X_j(t_m) = 0,
    0 = sum_j E_j (Y_j(t1) exp(-(t-t_m)/tau_j) + X_j(t)) + eta depth'(t).

What the rebound has to know of the approach between an earlier time t1 and the turn t_m.

A memory of the depth with rate 1/tau, or with none, sees of that stretch
    Y(t1) = int_{t1}^{t_m} exp(-(t_m-s)/tau) d depth(s),
which is summed from the turn back and not taken as a difference: near the turn it is as small as (t_m - t1)^2, and all
of its digits count.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from lumped.errors import NotReached
from lumped.numbers import Array, falling_zero, gauss
from lumped.result.history import End
from lumped.solvers.hereditary import pieces as forth
from lumped.solvers.hereditary.approach import Approach
from lumped.solvers.hereditary.march import Settings, Stretch
from lumped.solvers.hereditary.path import Path
from lumped.solvers.hereditary.pieces import Followed, HereditaryPiece
from lumped.solvers.hereditary.problem import Hereditary
from lumped.solvers.radau import Nodes

TIME, DEPTH, VELOCITY, WORK, FORCE, EDGE, MEMORIES = range(7)  # rows of the state
NEWTON_STEPS = 16  # work: of one piece of the rebound, more is no convergence
CONVERGED, ROUNDING = 1e-8, 1e-14  # rounding: last change over the largest pace; change of a time over the time
FIRST = 0.5  # work: first piece over the length of the way back
# Rounding: a change as small, over the largest pace, that does not halve the one before: Newton's steps square theirs.
NOISE, HALVED = 1e-4, 0.5
# Safety: a change of the pace as large has no solution; in place of a stiffness of zero, in a quotient.
DIVERGED, TINY = 1e100, 1e-200
# A turn with a force above the weight by less than this share of it is none: the striker has crept to rest.
BORNE = 1e-9
# The nodes of a piece integrate what fades by less than this power of e within it; a fade of FORGOTTEN leaves nothing.
RESOLVED, FORGOTTEN = 2.0, 40.0
NODES, WEIGHTS = gauss(32)  # Gauss's rule on (0, 1), over what a fast memory still sees


class Then(NamedTuple):
    """The approach at times t1 of the nodes: depth (N,), memories of the load, aged to the turn, and Y, both (J, N)."""

    depth: Array
    loads: Array
    rises: Array


@dataclass(frozen=True)
class Rebound:
    """How far it was followed, why it ended, and the Newton steps it took.

    Fields of the path over -sqrt(t1): time, depth, velocity, work done, force, depth at t1, memories X_j and Y_j.
    """

    path: Path
    end: End
    steps: int


@dataclass(frozen=True)
class ReboundPieces:
    """The pieces of a rebound that follows an approach."""

    problem: Hereditary
    past: Past
    table: Nodes
    before: Path | None

    def piece(self, place: float, length: float, state: Array) -> Followed[HereditaryPiece | None]:
        """The piece of a length at a place, from the state there; None where Newton's steps fail. It asks for none."""
        yield from ()
        over, weights = place + length * self.table.points, length * self.table.once
        then = self._then(place, over, weights, state)
        tried = (self._solved(weights, state, then, pace) for pace in self._paces(over))
        return next((found for found in tried if found), None)

    def _solved(self, weights: Array, state: Array, then: Then, pace: Array) -> HereditaryPiece | None:
        """Newton's steps for the pace p = dt/ds at the nodes, which lets nothing lack."""
        last = math.inf
        for step in range(1, NEWTON_STEPS + 1):
            now = Trial(self.problem, self.past.turn, weights, state, then, pace)
            change = np.linalg.solve(now.change_of_lack(), now.lack)
            pace = pace - change
            size, scale = float(np.abs(change).max()), float(np.abs(pace).max())
            if not size < DIVERGED:
                return None
            rounded = HALVED * last < size <= NOISE * scale
            last = size
            if size <= CONVERGED * scale or rounded or float(np.abs(weights @ change).max()) <= ROUNDING * now.time[-1]:
                values = Trial(self.problem, self.past.turn, weights, state, then, pace).values()
                ascends = bool(np.all(np.diff(values[TIME]) >= -ROUNDING * values[TIME, -1]))
                return HereditaryPiece(values, step) if ascends else None
        return None

    def _paces(self, over: Array) -> Iterator[Array]:
        """Guesses, the best first."""
        if self.before is not None:
            yield self.before.field(TIME, np.clip(over, self.before.breaks[0], self.before.breaks[-1]))[1]
        modulus = self.problem.modulus
        yield self._pace(over, modulus.glassy, modulus.viscosity)
        # Fast terms of the relaxation series are dashpots.
        dashpots = modulus.viscosity + float(self.problem.stiffnesses @ np.array(modulus.times))
        yield self._pace(over, modulus.equilibrium, dashpots)

    def _pace(self, over: Array, stiffness: float, viscosity: float) -> Array:
        """The pace on a spring and a dashpot near the turn t_m: E (t - t_m)^2 + 2 eta (t - t_m) = E (t_m - t1)^2."""
        spring = stiffness * self.past.age(over)
        return np.asarray(-2.0 * over * spring / np.maximum(np.hypot(viscosity, spring), TINY))

    def _then(self, place: float, over: Array, weights: Array, state: Array) -> Then:
        problem = self.problem
        earlier = self.past.path.at(-over)
        load, _ = problem.loads(earlier[0])
        loads = np.vstack([load, earlier[forth.MEMORIES :]])
        aged = np.exp(-problem.fadings[:, None] * self.past.age(over)) * loads
        known = state[MEMORIES + problem.springs.size :]
        return Then(earlier[0], aged, self.past.rises(place, over, weights, known))


class Trial:
    """One Newton iterate: times, motion and the lack that should vanish, at the nodes; `turn` is the time t_m."""

    def __init__(self, problem: Hereditary, turn: float, weights: Array, state: Array, then: Then, pace: Array) -> None:
        self.problem, self.weights, self.state, self.then, self.pace = problem, weights, state, then, pace
        springs, rates = problem.springs, problem.fadings
        self.time = state[TIME] + weights @ pace
        fade = np.exp(-np.maximum(self.time - turn, 0.0) * rates[:, None])
        self.force, self.forgotten = springs @ (fade * then.loads), (springs * rates) @ (fade * then.loads)
        self.velocity = state[VELOCITY] + weights @ ((problem.gravity - self.force) * pace)
        self.rise = weights @ (self.velocity * pace)
        self.ageing = np.eye(pace.size) + (weights * pace) * rates[:, None, None]
        held = state[MEMORIES : MEMORIES + rates.size, None] + self.rise
        self.memories = np.linalg.solve(self.ageing, held[..., None])[..., 0]
        self.fading = (springs * rates) @ (fade * then.rises)
        self.lack = springs @ (fade * then.rises + self.memories) + problem.modulus.viscosity * self.velocity

    def change_of_lack(self) -> Array:
        """d lack / d pace, (N, N)."""
        problem, weights, pace = self.problem, self.weights, self.pace
        velocity = weights * (problem.gravity - self.force) + (weights * (pace * self.forgotten)) @ weights
        depth = weights * self.velocity + (weights * pace) @ velocity
        aged = depth - weights * (self.memories * problem.fadings[:, None])[:, None, :]
        memory = np.tensordot(problem.springs, np.linalg.solve(self.ageing, aged), 1)
        change = memory + problem.modulus.viscosity * velocity
        return np.asarray(change - self.fading[:, None] * weights)

    def values(self) -> Array:
        """The fields at the first place and the nodes."""
        state, values = self.state, np.empty((self.state.size, self.pace.size + 1))
        values[:, 0] = state
        values[TIME, 1:], values[VELOCITY, 1:], values[FORCE, 1:] = self.time, self.velocity, self.force
        values[DEPTH, 1:], values[EDGE, 1:] = state[DEPTH] + self.rise, self.then.depth
        values[WORK, 1:] = state[WORK] + self.weights @ (self.force * self.velocity * self.pace)
        values[MEMORIES:, 1:] = np.vstack([self.memories, self.then.rises])
        return values


def rebound(
    problem: Hereditary, inward: Approach, end_time: float, settings: Settings, before: Rebound | None = None
) -> Followed[Rebound]:
    """Follow the rebound until contact closes, the striker approaches again, or `end_time`. Raises NotReached.

    `before` is the same found with fewer nodes: its pieces are kept, and it is where Newton starts.
    """
    known = before.path if before else None
    end, start = inward.path.end, _turned(problem, inward)
    if start[FORCE] <= problem.gravity * (1.0 + BORNE):
        still = np.repeat(start[:, None], settings.points + 1, 1)
        return Rebound(Path.of([-end, -end * (1.0 - 1e-12)], [still]), End.SECOND_APPROACH, 0)
    retreat = ReboundPieces(problem, Past(inward.path, forth.VELOCITY, problem.fadings), settings.table, known)

    def over(values: Array) -> bool:
        return bool(values[TIME, -1] >= end_time)

    stretch = Stretch(retreat.piece, FORCE, over, TIME)
    found = yield from stretch.march((-end, 0.0), start, FIRST * end, settings, before=known)
    path = found.path
    if found.over:
        low, high = (float(place) for place in path.breaks[-2:])
        time, _ = path.curve(TIME, len(path.coefficients) - 1)
        path = path.until(falling_zero(lambda place: end_time - time(place), low, high))
        return Rebound(path, End.TIME, found.steps)
    if found.stuck:
        if problem.gravity > 0.0:
            return Rebound(path, End.SECOND_APPROACH, found.steps)
        last = float(path.state(path.end)[TIME]) * problem.scales.time
        raise NotReached(f"the rebound could not be followed beyond {last:.6g} s")
    return Rebound(path, End.SEPARATED, found.steps)


def _turned(problem: Hereditary, inward: Approach) -> Array:
    """The state at the turn, the force from the memories as everywhere in the rebound."""
    depth, _, work, _, *memories = inward.path.state(inward.path.end)
    force = problem.springs @ np.append(problem.loads(depth)[0], memories)
    return np.array([inward.end, depth, 0.0, work, force, depth, *np.zeros(2 * problem.springs.size)])


@dataclass(frozen=True)
class Past:
    """The approach as a path over r = sqrt(t) up to its turn, its field of the velocity, and rates (J,)."""

    path: Path
    velocity: int
    rates: Array

    def rises(self, place: float, over: Array, weights: Array, known: Array) -> Array:
        """Y at places -sqrt(t1) `over`, (N,), from its values `known`, (J,), at a place before: shape (J, N).

        `weights`, (N, N), integrate from there what the nodes resolve.
        """
        rises = known[:, None] + self._faded(over, self.rates[:, None]) @ weights.T
        begun = self.age(place)
        steep = self.rates * (self.age(over[-1]) - begun) > RESOLVED
        for j in np.flatnonzero(steep & (self.rates * begun < FORGOTTEN)):
            rises[j] = known[j] + self._summed(place, over, float(self.rates[j]))
        return rises

    def _summed(self, place: float, over: Array, rate: float) -> Array:
        """What a fast memory gains from a place on to each of `over`, (N,): Gauss's rule over what it still sees."""
        earliest = max(place * place - FORGOTTEN / rate, 0.0)
        reach = np.minimum(over, -math.sqrt(earliest)) - place
        return reach * (self._faded(place + reach[:, None] * NODES, rate) @ WEIGHTS)

    def _faded(self, places: Array, rate: Array | float) -> Array:
        """-d Y / d place."""
        velocity = self.path.value(self.velocity, -places)
        return np.asarray(-2.0 * places * velocity * np.exp(-rate * self.age(places)))

    @property
    def turn(self) -> float:
        """t_m."""
        return self.path.end**2

    def age(self, places: Array | float) -> Array:
        """t_m - t1."""
        return np.asarray((self.path.end - places) * (self.path.end + places))
