"""The motion within one stage: steps as long as their accelerations are smooth, until an event, found exactly."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.collide.bodies import Bodies, PointLaw, Stage, State
from lumped.collide.step import NODES, STAGES, Step, roughness, solved
from lumped.errors import TooManySteps

Array = NDArray[np.float64]
# An event happens where its value, at the Radau points of a step, is no longer above zero.
Event = Callable[[Step], Array]

MOST_STEPS = 5000
LOCATIONS = 30
PRECISE = 1e-14  # of the time reached: where an event lies
SHORTEST, LONGEST, CAUTION = 0.1, 5.0, 0.8


@dataclass(frozen=True)
class Phase:
    """Steps of one stage, beginning at `start_time`, and the name of the event that ended it; None: the time did."""

    stage: Stage
    start_time: float
    steps: tuple[Step, ...]
    event: str | None

    @property
    def end_time(self) -> float:
        return self.start_time + sum(step.length for step in self.steps)

    @property
    def last(self) -> Step:
        return self.steps[-1]


@dataclass(frozen=True)
class March:
    """What one stage is marched with: the events by name, the last time, s, and the allowed roughness, m/s."""

    law: PointLaw
    stage: Stage
    bodies: Bodies
    events: Mapping[str, Event]
    until: float
    allowed: float

    def phase(self, start: State, time: float, length: float) -> Phase:
        """March from `start` with a first step of about `length`, s. Raises TooManySteps."""
        steps: list[Step] = []
        now, state = time, start
        guess = np.zeros(STAGES)
        for _ in range(MOST_STEPS):
            length = min(length, self.until - now)
            step = self._solved(state, length, guess)
            event = None if step is None else self._first(step)
            if step is not None and event is not None:
                step = self._located(step, event, now, guess)
            rough = np.inf if step is None else roughness(step) / self.allowed
            if step is None or rough > 1.0:
                length = (length if step is None else step.length) * _factor(rough)
                continue
            steps.append(step)
            now, state = now + step.length, step.end
            guess = np.full(STAGES, step.acceleration[-1])
            if event is not None or now >= self.until * (1.0 - PRECISE):
                return Phase(self.stage, time, tuple(steps), event)
            length = step.length * _factor(rough)
        raise TooManySteps(
            f"contact: {MOST_STEPS} time steps reach {now:.3g} s of {self.until:.3g} s; "
            "accepted: an earlier motion.end_time, or a law less stiff"
        )

    def _solved(self, state: State, length: float, guess: Array) -> Step | None:
        return solved(self.law, self.stage, self.bodies, state, length, guess)

    def _first(self, step: Step) -> str | None:
        """The event that happens first within a step."""
        places = {name: np.flatnonzero(value(step) <= 0.0) for name, value in self.events.items()}
        found = {name: int(place[0]) for name, place in places.items() if place.size}
        return min(found, key=lambda name: found[name]) if found else None

    def _located(self, step: Step, event: str, now: float, guess: Array) -> Step | None:
        """The step that ends where the event happens: secants on its length, kept between what brackets it."""
        value = self.events[event]
        values = value(step)
        after = int(np.flatnonzero(values <= 0.0)[0])
        high, at_high = float(NODES.points[after]) * step.length, float(values[after])
        low = float(NODES.points[after - 1]) * step.length if after else 0.0
        at_low = float(values[after - 1]) if after else -at_high
        previous, at_previous, length, trial = high, at_high, _secant(low, at_low, high, at_high), None
        for _ in range(LOCATIONS):
            trial = self._solved(step.start, length, guess)
            if trial is None:
                return None
            at = float(value(trial)[-1])
            low, high = (low, length) if at <= 0.0 else (length, high)
            following = _secant(previous, at_previous, length, at)
            if not low < following < high:
                following = 0.5 * (low + high)
            if at == 0.0 or abs(following - length) <= PRECISE * (now + length):
                return trial
            previous, at_previous, length = length, at, following
        return trial


def _secant(one: float, at_one: float, other: float, at_other: float) -> float:
    """Where the line through two points is zero; the second where it is level."""
    return other - at_other * (other - one) / (at_other - at_one) if at_other != at_one else other


def _factor(rough: float) -> float:
    """How much longer the next step may be: the last Legendre terms fall with the power s of the length."""
    if rough == 0.0:
        return LONGEST
    return float(np.clip(CAUTION * rough ** (-1.0 / STAGES), SHORTEST, LONGEST))
