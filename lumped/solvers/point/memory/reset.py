"""Reset: the surface is relaxed and flat again whenever the bodies meet."""

from __future__ import annotations

from lumped.solvers.point.bodies import Bodies, State, flown, time_to_return
from lumped.solvers.point.memory.base import HereditaryLoad, MemoryRule


def returned(load: HereditaryLoad, bodies: Bodies, last: State) -> tuple[float, State] | None:
    """They meet at depth zero; bodies that do not leave the dent by then never count as apart."""
    time = time_to_return(last, bodies.gravity, 0.0)
    if time is None:
        return None
    return time, flown(last, bodies.gravity, time)._replace(depth=0.0, memory=load.at_rest)


MEMBER = MemoryRule(returned)
