"""What moves, what it meets, what the law remembers between two events, one step of the motion, and free flight."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from lumped.numbers import Array, Real, bisected
from lumped.solvers.radau import Nodes

# The least depth a law is asked for: powers below one of it stay finite, as do their slopes.
TINY = 1e-200


class Bodies(NamedTuple):
    """The relative motion of two masses: reduced mass, kg; velocity at touch, m/s; gravity along it, m/s2."""

    mass: float
    velocity: float
    gravity: float = 0.0


class Stage(NamedTuple):
    """Whether the bodies approach, the deepest indentation of this contact so far, m, and its speed at touch, m/s.

    `turn`: the depth where the stage began, m; `kept`: what the law keeps of the stages before.
    """

    approaching: bool
    deepest: float
    speed: float
    turn: float = 0.0
    kept: tuple[float, ...] = ()


class State(NamedTuple):
    """Depth, m, its rate, m/s, the work lost since the first touch, J, and what the law remembers."""

    depth: float
    rate: float
    lost: float
    memory: tuple[float, ...] = ()


class Step(NamedTuple):
    """One step from `start`, `length` s long; gains, rates, depths and forces at the points of `nodes`, shape (s,).

    A gain, m/s2, is the acceleration times the pace of the nodes: the rate's slope over the place.
    """

    start: State
    length: float
    nodes: Nodes
    gain: Array
    rate: Array
    depth: Array
    force: Array
    end: State
    iterations: int

    @property
    def last_acceleration(self) -> float:
        """At its end, m/s2; not for a step whose nodes are mirrored."""
        return float(self.gain[-1] / self.nodes.pace[-1])

    def last_slope(self, values: Array) -> float:
        """The slope over time, at its end, of what has these values at its points; not for mirrored nodes."""
        return float(self.nodes.leaving @ values / (self.nodes.pace[-1] * self.length))

    def accelerations(self, shares: Array) -> Array:
        """By its polynomial, m/s2, at shares of its time in (0, 1], shape (n,); not for mirrored nodes."""
        power, begun = self.nodes.power, self.nodes.begun
        if power == 1:
            return np.asarray(legendre.legval(2.0 * shares - 1.0, self.nodes.series @ self.gain))
        low, high = self.nodes.roots
        root = (shares + begun) ** (1.0 / power)
        gains = legendre.legval(2.0 * (root - low) / (high - low) - 1.0, self.nodes.series @ self.gain)
        return np.asarray(gains / (power * (high - low) * root ** (power - 1)))


class PointLaw(ABC):
    """A force between two masses, F(depth, rate), N; depths >= 0 in m, rates in m/s, scalars or arrays.

    Within one stage the force is smooth but for its corners. What is said here is so without a memory, without
    corners, and where the force is smooth in time from touch on.
    """

    @property
    def tensile(self) -> bool:
        """Whether it pulls before the depth is zero, in every rebound."""
        return False

    def letting_go(self, stage: Stage) -> float:
        """The rate, m/s, below which it pulls at every depth; no rebound is so fast but one that something drives."""
        return -math.inf

    def grading(self, stage: Stage) -> int:
        """The power p for which a stage's force near depth zero is smooth in the p-th root of the time from there."""
        return 1

    def touch(self, bodies: Bodies) -> State:
        """The state at first touch: at the surface, nothing lost yet."""
        return State(0.0, bodies.velocity, 0.0)

    def within(self, start: State, length: float) -> PointLaw:
        """The law as the Radau points of one step see it, which begins at `start` and is `length` s long.

        Itself without memory. With memory the force at one point depends on the depths at the others too: the
        slope over depth is then a matrix (s, s).
        """
        return self

    def remembered(self, depth: Array) -> tuple[float, ...]:
        """The memory at the end of such a step, from the depths at its points, shape (s,)."""
        return ()

    @abstractmethod
    def force(self, depth: Real, rate: Real, stage: Stage) -> Real:
        """F, N, compression positive; depth >= 0, m, rate, m/s."""

    @abstractmethod
    def tangents(self, depth: Real, rate: Real, stage: Stage) -> tuple[Real, Real]:
        """dF/d depth, N/m, and dF/d rate, N s/m."""

    def corners(self, stage: Stage) -> tuple[float, ...]:
        """Depths, m, in the order in which a stage meets them, where the force has a corner."""
        return ()

    def kept(self, depth: float, stage: Stage) -> tuple[float, ...]:
        """What the next stage has to know of this one, which ends at `depth`."""
        return ()

    def between(
        self, steps: Sequence[Step], place: NDArray[np.intp], share: Array, depth: Array, rate: Array, stage: Stage
    ) -> Array:
        """F at places in a row of steps, each shape (n,): which step, what share of it has passed, depth and rate.

        Without memory where in the steps does not matter.
        """
        return np.asarray(self.force(np.maximum(depth, TINY), rate, stage))

    def returned(self, bodies: Bodies, last: State) -> tuple[float, State] | None:
        """How long the bodies are apart after a contact, s, and the state when they meet again; None: for ever.

        They meet at depth zero, the surface as it was; where gravity turns them before they have left the dent, when
        the force rises above zero.
        """
        gravity = bodies.gravity
        if gravity <= 0.0:
            return None
        time = time_to_return(last, gravity, 0.0)
        if time is not None:
            return time, flown(last, gravity, time)._replace(depth=0.0)
        stage = Stage(False, last.depth, bodies.velocity)

        def apart(elapsed: float) -> bool:
            there = flown(last, gravity, elapsed)
            return bool(self.force(there.depth, there.rate, stage) <= 0.0)

        _, time = bisected(apart, 0.0, -last.rate / gravity)
        return time, flown(last, gravity, time)

    def dent(self, last: State, stage: Stage) -> Dent:
        """What a contact leaves that ended as `last`, in a `stage`."""
        return Dent(self, stage)

    def carried(self, depth: float, stage: Stage) -> float:
        """The weight, N, under which a striker stays at rest at a depth; NaN of what creeps under every one."""
        return float(self.force(depth, 0.0, stage))

    @abstractmethod
    def lost(self, depth: Real, rate: Real, stage: Stage) -> Real:
        """The part of the force whose work is not stored, N."""

    @abstractmethod
    def stored(self, depth: float, stage: Stage) -> float:
        """Energy that the law could still give back at a depth, J."""

    @abstractmethod
    def time_scale(self, bodies: Bodies) -> float:
        """A time in which an impact changes by its own size, s: the elastic contact time."""


@dataclass(frozen=True)
class Dent:
    """What a contact leaves behind. Without memory the law presses as ever where the bodies overlap."""

    law: PointLaw
    stage: Stage

    def resistance(self, depth: Array, rate: Array, since: Array) -> Array:
        """Above zero where it is pressed again, `since` s after the contact; each (n,)."""
        return np.where(depth > 0.0, self.law.force(np.maximum(depth, TINY), rate, self.stage), -1.0)

    def recalled(self, since: float) -> tuple[float, ...]:
        """The law's memory when it is pressed again."""
        return ()

    def forgotten(self, since: float) -> bool:
        """Whether it counts as gone where nothing lies in it any more."""
        return True


def flown(state: State, gravity: float, time: float) -> State:
    """The state after free flight of `time`, s."""
    depth = state.depth + time * (state.rate + 0.5 * gravity * time)
    return State(depth, state.rate + gravity * time, state.lost)


def time_to_return(last: State, gravity: float, depth: float) -> float | None:
    """When free flight from `last` comes down to a depth again, s; None where it never leaves it, or never returns."""
    if gravity <= 0.0:
        return None
    top = -last.rate / gravity
    fall = depth - flown(last, gravity, top).depth
    return top + math.sqrt(2.0 * fall / gravity) if fall >= 0.0 else None
