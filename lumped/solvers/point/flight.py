"""Free flight between two contacts, under gravity."""

from __future__ import annotations

import math
from collections.abc import Callable

from lumped.solvers.point.bodies import Bodies, PointLaw, Stage, State

BISECTIONS = 200


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


def returned(law: PointLaw, bodies: Bodies, last: State) -> tuple[float, State] | None:
    """Flight of a law without memory: s, and the state when the bodies meet again; None for ever.

    They meet at depth zero; where gravity turns them before they have left the dent, when the force of the law
    rises above zero.
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
        return bool(law.force(there.depth, there.rate, stage) <= 0.0)

    time = bisected(apart, 0.0, -last.rate / gravity)
    return time, flown(last, gravity, time)


def bisected(before: Callable[[float], bool], low: float, high: float) -> float:
    """Where `before` stops being true between `low`, where it is, and `high`, to the last digit."""
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (middle, high) if before(middle) else (low, middle)
    return high
