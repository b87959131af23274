"""Continuous: the transfer function keeps running on the depth above zero, as if the bodies still touched.

Contact begins again when its force, counted as zero while it is negative, rises above zero.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lumped.solvers.point.bodies import Bodies, State, bisected, flown, time_to_return
from lumped.solvers.point.memory.base import HereditaryLoad, MemoryRule, StepLoad
from lumped.solvers.point.phase import NODES

Array = NDArray[np.float64]
STEPS = 16


def returned(load: HereditaryLoad, bodies: Bodies, last: State) -> tuple[float, State] | None:
    """They meet after the top of the flight, where the formula of the force becomes positive."""
    if bodies.gravity <= 0.0:
        return None
    top = -last.rate / bodies.gravity
    left = top - ((time_to_return(last, bodies.gravity, 0.0) or top) - top)
    memory = _run(load, bodies, last, last.memory, 0.0, left)
    low = 2.0 * top - left
    memory = _run(load, bodies, last, memory, left, low)

    def apart(time: float) -> bool:
        there = flown(last, bodies.gravity, time)
        return bool(load.force(there.depth, there.rate, _run(load, bodies, last, memory, low, time)) <= 0.0)

    time = bisected(apart, low, 2.0 * top)
    kept = _run(load, bodies, last, memory, low, time)
    return time, flown(last, bodies.gravity, time)._replace(memory=kept)


def _run(
    load: HereditaryLoad, bodies: Bodies, last: State, memory: tuple[float, ...], start: float, end: float
) -> tuple[float, ...]:
    """The memory at `end` from that at `start`, times of flight, s."""
    if end <= start:
        return memory
    length = (end - start) / STEPS
    for begin in start + length * np.arange(STEPS):
        times = begin + length * NODES.points
        depth = last.depth + times * (last.rate + 0.5 * bodies.gravity * times)
        memory = tuple(StepLoad.of(load, memory, length, NODES).memories(depth)[:, -1].tolist())
    return memory


MEMBER = MemoryRule(returned)
