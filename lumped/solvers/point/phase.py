"""The motion within one stage: steps as long as their accelerations are smooth, until an event, found exactly.

One step: the accelerations at all Radau points at once, by Newton's method.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dgesv

from lumped.errors import TooManySteps
from lumped.numbers import Array
from lumped.progress import step_done
from lumped.result.history import AT_REST
from lumped.solvers.point.bodies import TINY, Bodies, PointLaw, Stage, State, Step
from lumped.solvers.radau import NODES, SHORTEST, STAGES, Nodes

ITERATIONS = 12  # work: Newton's, of one step
# Newton's last correction times its ratio to the one before is more than what is left; relative to the largest gain
# and to the gain that would change the rate by as much as it is.
SMALL = 1e-11
# A correction as small as this is rounding.
ROUNDING = 1e-14
MOST_STEPS = 5000  # work: time steps of one phase
LOCATIONS = 60  # work: trials of where in a step an event lies
PRECISE = 1e-14  # rounding: of the time since a stage began, where in it an event lies; of the last time
# Rounding: of a step's length, by which it still changes where it ends with an event; so much of the change before is
# left of what falls no more.
ROUNDED, NO_BETTER = 1e-6, 0.5
LINEAR = 0.9  # secants leave so much less of it, where a force ends like a power of the time up to the fifth
# So much rougher than allowed a step need not be located any better to be refused.
HOPELESS = 2.0


def solved(
    law: PointLaw, stage: Stage, bodies: Bodies, start: State, length: float, guess: Array, nodes: Nodes = NODES
) -> Step | None:
    """The step whose accelerations satisfy m a + F(depth, rate) = m g at every point; None without convergence."""
    once, twice = length * nodes.once, length**2 * nodes.twice
    ballistic = start.depth + length * start.rate * nodes.points
    pull, push = nodes.pace * bodies.gravity, nodes.pace / bodies.mass
    turning, bending = push[:, None] * once, push[:, None] * twice
    gain, seen, before = guess, law.within(start, length), 0.0
    for iteration in range(1, ITERATIONS + 1):
        rate = start.rate + once @ gain
        depth = ballistic + twice @ gain
        pressed = np.maximum(depth, TINY)
        excess = gain - pull + push * seen.force(pressed, rate, stage)
        stiffness, damping = seen.tangents(pressed, rate, stage)
        over_depth = stiffness * (depth > 0.0)
        jacobian = push[:, None] * (over_depth @ twice) if over_depth.ndim == 2 else over_depth[:, None] * bending
        jacobian += damping[:, None] * turning
        jacobian.flat[:: STAGES + 1] += 1.0
        correction = dgesv(jacobian, excess)[2]
        gain = gain - correction
        size = float(np.abs(correction).max())
        scale = abs(gain[0]) + abs(gain[-1]) + (abs(start.rate) + abs(rate[-1])) / length
        if not math.isfinite(size):
            return None
        if size <= ROUNDING * scale or size * size <= SMALL * scale * before:
            return _finished(seen, stage, bodies, start, length, nodes, gain, iteration)
        before = size
    return None


def _finished(
    law: PointLaw, stage: Stage, bodies: Bodies, start: State, length: float, nodes: Nodes, gain: Array, count: int
) -> Step:
    rate = start.rate + length * (nodes.once @ gain)
    depth = start.depth + length * (start.rate * nodes.points + length * (nodes.twice @ gain))
    pressed = np.maximum(depth, TINY)
    power = nodes.pace * law.lost(pressed, rate, stage) * rate
    lost = start.lost + length * float(nodes.weights @ power)
    end = State(float(depth[-1]), float(rate[-1]), lost, law.remembered(pressed))
    acceleration = gain
    if nodes.power > 1:
        acceleration = np.divide(gain, nodes.pace, out=np.full(STAGES, bodies.gravity), where=nodes.pace > 0.0)
    # Gravity less the acceleration would leave of a faint force its rounding alone.
    force = law.force(pressed, rate, stage) if bodies.gravity else -bodies.mass * acceleration
    return Step(start, length, nodes, gain, rate, depth, force, end, count)


def roughness(step: Step) -> float:
    """What the last Legendre terms of the gain are worth in rate over the step, m/s."""
    return step.length * float(np.abs(step.nodes.series[-2:] @ step.gain).max())


DEPTH, RATE, FORCE = range(3)


class Event(NamedTuple):
    """An event happens where its value, at the points of a step, is no longer above zero.

    `slope`: the value's slope over time at the end of a step; where it is rough secants take its place. `told_by`:
    which of DEPTH, RATE and FORCE its value goes with.
    """

    value: Callable[[Step], Array]
    slope: Callable[[Step], float]
    rough: bool = False
    told_by: int = FORCE

    @property
    def surfaces(self) -> bool:
        """Whether it happens at depth zero."""
        return self.told_by == DEPTH


@dataclass(frozen=True)
class PointPhase:
    """Steps of one stage, beginning at `start_time`, and the name of the event that ended it; None: the time did."""

    stage: Stage
    start_time: float
    steps: tuple[Step, ...]
    event: str | None

    @cached_property
    def times(self) -> Array:
        """Where its steps begin, and where the last one ends, s, shape (n + 1,)."""
        return self.start_time + np.cumsum([0.0, *(step.length for step in self.steps)])

    @property
    def end_time(self) -> float:
        return float(self.times[-1])

    @property
    def last(self) -> Step:
        return self.steps[-1]


@dataclass(frozen=True)
class PointMarch:
    """What one stage is marched with: the events by name, the last time, s, and the allowed roughness, m/s."""

    law: PointLaw
    stage: Stage
    bodies: Bodies
    events: Mapping[str, Event]
    until: float
    allowed: float

    def phase(self, start: State, time: float, length: float) -> PointPhase:
        """March from `start` with a first step of about `length`, s. Raises TooManySteps."""
        steps: list[Step] = []
        now, state, guess = time, start, np.full(STAGES, self.bodies.gravity)
        power = self.law.grading(self.stage) if start.depth <= 0.0 else 1
        for _ in range(MOST_STEPS):
            length = min(length, self.until - now)
            nodes = NODES.graded(power, (now - time) / length) if power > 1 else NODES
            step, event = self._until_event(self._solved(state, length, guess * nodes.pace, nodes), now - time)
            if step is None:
                length *= SHORTEST
                continue
            rough = roughness(step) / self.allowed
            if rough > 1.0:
                length = step.length * step.nodes.again(rough)
                continue
            steps.append(step)
            now, state = now + step.length, step.end
            event = event or ("rest" if self._rests(state) else None)
            if event is not None or now >= self.until * (1.0 - PRECISE):
                return PointPhase(self.stage, time, tuple(steps), event)
            length = step.length * nodes.following(rough)
            guess = step.last_acceleration + step.last_slope(step.gain / step.nodes.pace) * length * NODES.points
        raise TooManySteps(
            f"contact: {MOST_STEPS} time steps reach {now:.3g} s of {self.until:.3g} s; "
            "accepted: an earlier motion.end_time, or a law less stiff"
        )

    def _rests(self, state: State) -> bool:
        """Whether gravity has pressed the striker to where the law carries it."""
        weight = self.bodies.mass * self.bodies.gravity
        if weight <= 0.0 or state.depth <= 0.0 or abs(state.rate) > AT_REST * self.bodies.velocity:
            return False
        return abs(self.law.carried(state.depth, self.stage) - weight) <= AT_REST * weight

    def _solved(self, state: State, length: float, guess: Array, nodes: Nodes) -> Step | None:
        step_done()
        return solved(self.law, self.stage, self.bodies, state, length, guess, nodes)

    def _until_event(self, step: Step | None, since: float, known: str = "") -> tuple[Step | None, str | None]:
        """The step, cut short at its first event; and at one before that which only the shorter step shows.

        It begins ``since`` s after its stage.
        """
        event = None if step is None else self._first(step, known)
        if step is None or event is None:
            return step, known or None
        located = self._located(step, event, since)
        return (located, event) if known else self._until_event(located, since, event)

    def _first(self, step: Step, beside: str = "") -> str | None:
        """The event that happens first within a step, `beside` one that is known."""
        others = {name: event for name, event in self.events.items() if name != beside}
        places = {name: np.flatnonzero(event.value(step) <= 0.0) for name, event in others.items()}
        found = {name: int(place[0]) for name, place in places.items() if place.size}
        return min(found, key=lambda name: found[name]) if found else None

    def _located(self, step: Step, name: str, since: float) -> Step | None:
        """The step that ends where the event happens: Newton's method on its length, kept between what brackets it.

        Or one near it that is too rough anyway. How late it is by the clock does not matter: at a turn the rate that is
        left is dropped.
        """
        event = self.events[name]
        low, high, length = 0.0, 2.0 * step.length, _expected(step, event.value(step))
        nodes = self._ending(step, event, length)
        guess = nodes.pace * step.accelerations(nodes.points * (length / step.length))
        previous: tuple[float, float] | None = None
        before = math.inf
        for _ in range(LOCATIONS):
            trial = self._solved(step.start, length, guess, nodes)
            if trial is None:
                return None
            if roughness(trial) > HOPELESS * self.allowed:
                return trial
            at = float(event.value(trial)[-1])
            slope = event.slope(trial)
            if event.rough and previous is not None and previous[0] != length:
                slope = (at - previous[1]) / (length - previous[0])
            low, high = (low, length) if at <= 0.0 else (length, high)
            following = length - at / slope if slope < 0.0 else low
            change = abs(following - length)
            rounded = change <= ROUNDED * length and change > (LINEAR if event.rough else NO_BETTER) * before
            if at == 0.0 or rounded or change <= PRECISE * (since + length):
                return trial
            before = change
            previous, length = (length, at), following if low < following < high else 0.5 * (low + high)
            nodes, guess = self._ending(step, event, length), trial.gain
        return trial

    def _ending(self, step: Step, event: Event, length: float) -> Nodes:
        """The nodes of a step of another length, s, which ends with an event."""
        if length == 0.0:  # a step that ends where it begins
            return NODES
        left = self.law.grading(self.stage) if event.surfaces and step.nodes.power == 1 else 1
        if left > 1:
            return NODES.graded(left, begun=0.0, mirrored=True)
        power, begun = step.nodes.power, step.nodes.begun * step.length / length
        return NODES.graded(power, begun) if power > 1 else NODES


def _expected(step: Step, values: Array) -> float:
    """After what time an event should happen, s, from its values at the points of a step: a line between two."""
    after = int(np.flatnonzero(values <= 0.0)[0])
    high, at_high = float(step.nodes.points[after]), float(values[after])
    low, at_low = (float(step.nodes.points[after - 1]), float(values[after - 1])) if after else (0.0, -at_high)
    share = high - at_high * (high - low) / (at_high - at_low) if at_high != at_low else high
    return share * step.length
