"""Free flight between two contacts, under gravity."""

from __future__ import annotations

import math
from collections.abc import Callable

from lumped.collide.bodies import Bodies, PointLaw, Stage, State

BISECTIONS = 200


def flown(state: State, gravity: float, time: float) -> State:
    """The state after free flight of `time`, s."""
    depth = state.depth + time * (state.rate + 0.5 * gravity * time)
    return State(depth, state.rate + gravity * time, state.lost)


def returned(law: PointLaw, bodies: Bodies, last: State) -> tuple[float, State] | None:
    """Flight of a law without memory: s, and the state when the bodies meet again; None for ever.

    They meet at depth zero; where gravity turns them before they have left the dent, when the force of the law
    rises above zero.
    """
    gravity = bodies.gravity
    if gravity <= 0.0:
        return None
    top = -last.rate / gravity
    highest = flown(last, gravity, top).depth
    if highest <= 0.0:
        time = top + math.sqrt(-2.0 * highest / gravity)
        return time, flown(last, gravity, time)._replace(depth=0.0)
    stage = Stage(False, last.depth, bodies.velocity)

    def apart(time: float) -> bool:
        there = flown(last, gravity, time)
        return bool(law.force(there.depth, there.rate, stage) <= 0.0)

    time = bisected(apart, 0.0, top)
    return time, flown(last, gravity, time)


def bisected(before: Callable[[float], bool], low: float, high: float) -> float:
    """Where `before` stops being true between `low`, where it is, and `high`, to the last digit."""
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (middle, high) if before(middle) else (low, middle)
    return high
