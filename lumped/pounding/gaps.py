"""What a gap does: apart, pressed, or leaving a dent without force; and what ends each.

A gap that is apart touches where its depth rises through zero, a dent is pressed again where its surface is met. Where
the depth may have come up to zero between two points of a step and gone again, the step is first cut at the closest
approach, so that no touch is missed.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumped.laws._force_law import ForceLaw
from lumped.numbers import Array
from lumped.solvers.point.bodies import Bodies, Dent, Stage, State
from lumped.solvers.point.contact import following, force_left
from lumped.solvers.radau import Nodes

UNTOUCHED = Stage(True, 0.0, 0.0)
PULLED = 1e-9  # rounding: of its spring's force, what a law whose rebound almost lets go may pull with


class Mode(Enum):
    """What a gap does."""

    APART = "the storeys are clear of each other"
    PRESSED = "they press each other"
    FOLLOWED = "they would pull, but the surface goes along without force"
    LEAVING = "they have parted, but a dent is left between them"


class Happening(Enum):
    """What ends a step."""

    NEAREST = "closest approach without touch"
    TOUCH = "first touch"
    TURN = "approach becomes rebound, or rebound approach"
    CORNER = "a corner of the law"
    EXIT = "the end of contact"
    LEFT = "out of the dent"
    AGAIN = "pressed again within the dent"


class FrameStep(NamedTuple):
    """One step, `length` s long: states (s, 2 n), and depths, rates and forces of all gaps, (m, s), at its points.

    `gain`, N, is the force times the pace of the nodes; `first_depth` and `first_rate` are those where it begins, (m,);
    `memories`: what the laws remember at its end; `tension`: the forces that followed surfaces are spared, (m, s).
    """

    length: float
    nodes: Nodes
    states: Array
    first_depth: Array
    first_rate: Array
    depth: Array
    rate: Array
    force: Array
    gain: Array
    memories: tuple[tuple[float, ...], ...]
    tension: Array

    def slope(self, values: Array) -> float:
        """Over time at its end of what has these values at its points; not a number for mirrored nodes."""
        pace = float(self.nodes.pace[-1])
        return float(self.nodes.leaving @ values) / (pace * self.length) if pace > 0.0 else float("nan")


@dataclass(frozen=True)
class GapState:
    """A gap where a step begins. `stage` counts while it is pressed or leaving, `corners` are those still ahead.

    `touched`: when it was touched, s, while the force still grows from depth zero, else None; `passed`: the closest
    approach has just been here; `memory`: the law's; `parted`: the dent of the last contact, and when it ended, s.
    """

    mode: Mode
    stage: Stage = UNTOUCHED
    corners: tuple[float, ...] = ()
    touched: float | None = None
    passed: bool = False
    memory: tuple[float, ...] = ()
    parted: tuple[Dent, float] | None = None

    @property
    def active(self) -> bool:
        """Whether the law runs along."""
        return self.mode in (Mode.PRESSED, Mode.FOLLOWED)


OPEN = GapState(Mode.APART)


def pressed(law: ForceLaw, depth: float, rate: float, slowest: float, time: float) -> GapState:
    """Pressed from `time`, s, on, at a depth, m, and a rate, m/s, of which no law is told less than `slowest`."""
    speed = max(abs(rate), slowest)
    stage = Stage(rate > 0.0 or depth <= 0.0, depth, speed, depth)
    touched = time if depth <= 0.0 else None
    return GapState(Mode.PRESSED, stage, law.corners(stage), touched, memory=law.touch(Bodies(1.0, speed)).memory)


def again(law: ForceLaw, dent: Dent, since: float, *touch: float) -> GapState:
    """A dent pressed again, as by :func:`pressed` with the arguments of `touch`; or followed, where it would pull.

    The speed at touch is that with which the dent was made, for storeys that have not left it touch no second time.
    """
    depth, rate = touch[:2]
    memory = dent.recalled(since)
    mode = Mode.FOLLOWED if law.follows and law.at_start(depth, rate, memory) < 0.0 else Mode.PRESSED
    found = pressed(law, *touch)
    return replace(found, mode=mode, stage=found.stage._replace(speed=dent.stage.speed), memory=memory)


class GapEvent(NamedTuple):
    """It happens at the first point of a step where its value is no longer above zero, of those that `only` leaves."""

    gap: int
    happening: Happening
    value: Callable[[FrameStep], Array]
    only: Callable[[FrameStep], NDArray[np.bool_]] | None = None
    surfaces: bool = False

    def first(self, step: FrameStep) -> int | None:
        """The point where it has happened."""
        fallen = self.value(step) <= 0.0
        if self.only is not None:
            fallen &= self.only(step)
        return int(fallen.argmax()) if fallen.any() else None


def events_of(gap: int, state: GapState, law: ForceLaw, depth: float, noise: float, time: float) -> list[GapEvent]:
    """What can end a step of a gap from `time`, s, and `depth`, m, on; `noise`: a depth that is rounding."""
    if state.mode is Mode.APART:
        return [_touch(gap, depth, noise), _nearest(gap, state, noise)]
    left = GapEvent(gap, Happening.LEFT, lambda step: step.depth[gap])
    if state.parted is not None:
        met = [_again(gap, *state.parted, time), _nearest(gap, state, noise)]
        return [*met, left] if depth > 0.0 else met
    if state.mode is Mode.FOLLOWED:
        return [GapEvent(gap, Happening.AGAIN, lambda step: step.tension[gap]), left]
    sign = 1.0 if state.stage.approaching else -1.0
    found = [GapEvent(gap, Happening.TURN, lambda step: sign * step.rate[gap])]
    if state.corners:
        corner = state.corners[0]
        found.append(GapEvent(gap, Happening.CORNER, lambda step: sign * (corner - step.depth[gap])))
    by_force = law.tensile and law.exit == "force"

    def value(step: FrameStep) -> Array:
        return force_left(step.depth[gap], step.force[gap]) if by_force else step.depth[gap]

    if not state.stage.approaching:
        rate = law.letting_go(state.stage) * (1.0 + PULLED)
        found.append(GapEvent(gap, Happening.EXIT, value, surfaces=not by_force))
        if law.exit == "force" and rate > -math.inf:
            found.append(GapEvent(gap, Happening.EXIT, lambda step: step.rate[gap] - rate))
    elif law.follows:
        found.append(GapEvent(gap, Happening.EXIT, value, lambda step: np.maximum.accumulate(step.force[gap] > 0.0)))
    return found


def _touch(gap: int, depth: float, noise: float) -> GapEvent:
    """From a depth of zero the depth itself vanishes: then its mean rate since tells of the next touch."""
    if depth < 0.0:
        return GapEvent(gap, Happening.TOUCH, lambda step: noise - step.depth[gap])
    return GapEvent(gap, Happening.TOUCH, lambda step: (noise - step.depth[gap]) / step.nodes.points)


def _nearest(gap: int, state: GapState, noise: float) -> GapEvent:
    """The depth turns between two points so near to zero that its tangents there reach it."""

    def suspicious(step: FrameStep) -> NDArray[np.bool_]:
        rate = np.append(step.first_rate[gap], step.rate[gap])
        depth = np.append(step.first_depth[gap], step.depth[gap])
        apart = step.length * np.diff(step.nodes.points, prepend=0.0)
        turned = (rate[:-1] > 0.0) & (rate[1:] < 0.0)
        reach = np.maximum(depth[:-1], depth[1:]) + apart * np.maximum(rate[:-1], -rate[1:])
        found = turned & (reach > noise)
        found[0] &= not state.passed
        return np.asarray(found)

    return GapEvent(gap, Happening.NEAREST, lambda step: step.rate[gap], suspicious)


def _again(gap: int, dent: Dent, parted: float, time: float) -> GapEvent:
    """The law, which does not act here, would press again."""

    def value(step: FrameStep) -> Array:
        since = time - parted + step.length * step.nodes.points
        return -dent.resistance(step.depth[gap], step.rate[gap], since)

    def rising(step: FrameStep) -> NDArray[np.bool_]:
        begun = dent.resistance(step.first_depth[[gap]], step.first_rate[[gap]], np.array([time - parted]))
        return np.asarray(np.diff(value(step), prepend=-begun) < 0.0)

    return GapEvent(gap, Happening.AGAIN, value, rising)


def after(
    event: GapEvent, state: GapState, law: ForceLaw, depth: float, rate: float, slowest: float, time: float
) -> tuple[GapState, float]:
    """The gap after what happened to it at a depth, m, and at a rate, m/s; and its depth, zero at the surface."""
    match event.happening:
        case Happening.NEAREST:
            return replace(state, passed=True), depth
        case Happening.TOUCH:
            return (pressed(law, 0.0, rate, slowest, time) if rate > 0.0 else OPEN), 0.0
        case Happening.TURN:
            stage = following(law, state.stage, depth)
            return replace(state, stage=stage, corners=law.corners(stage), touched=None), depth
        case Happening.CORNER:
            return replace(state, corners=state.corners[1:]), depth
        case Happening.AGAIN if state.parted is not None:
            dent, parted = state.parted
            return again(law, dent, time - parted, depth, rate, slowest, time), depth
        case Happening.AGAIN:
            return replace(pressed(law, depth, rate, slowest, time), memory=state.memory), depth
        case Happening.EXIT if law.follows:
            return replace(state, mode=Mode.FOLLOWED, corners=(), touched=None), depth
        case Happening.EXIT:
            dent = law.dent(State(depth, rate, 0.0, state.memory), state.stage)
            left = replace(state, mode=Mode.LEAVING, corners=(), touched=None, parted=(dent, time))
            return (surfaced(left, 0.0, time), 0.0) if event.surfaces else (left, depth)
        case _ if state.mode is Mode.FOLLOWED:
            dent = law.dent(State(0.0, rate, 0.0, state.memory), state.stage)
            return surfaced(replace(state, mode=Mode.LEAVING, parted=(dent, time)), 0.0, time), 0.0
        case _:
            return surfaced(state, 0.0, time), 0.0


def surfaced(state: GapState, depth: float, time: float) -> GapState:
    """The gap apart, where it has left a dent, at a depth, m, that is forgotten; else as it is."""
    if state.mode is not Mode.LEAVING or depth > 0.0:
        return state
    return OPEN if state.parted is None or state.parted[0].forgotten(time - state.parted[1]) else state
