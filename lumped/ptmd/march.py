"""The march through the phases of a motion, the same for either route."""

from __future__ import annotations

from lumped.errors import NotReached
from lumped.ptmd import exact, integrated
from lumped.ptmd.equations import Equations
from lumped.ptmd.phase import Follow, PtmdPhase
from lumped.ptmd.switches import after, first_stages
from lumped.ptmd.system import Start

MOST_SWITCHES = 20_000


def route_of(name: str, equations: Equations, start: Start, spacing: float, end_time: float) -> Follow:
    """How a phase is followed: "exact" (exponent 1) or "integrated"."""
    if name == "exact":
        return exact.route(equations, spacing, end_time)
    return integrated.route(equations, start, spacing, end_time)


def most_rows(name: str) -> int:
    """How many rows a route may take."""
    return exact.MOST_ROWS if name == "exact" else integrated.MOST_ROWS


def march(equations: Equations, start: Start, end_time: float, follow: Follow) -> tuple[PtmdPhase, ...]:
    """The phases from t = 0 to `end_time`, s. Raises NotReached when the ring switches without end."""
    phases: list[PtmdPhase] = []
    state, time = equations.initial(start), 0.0
    stages = first_stages(equations, state)
    for _ in range(MOST_SWITCHES):
        phase, switch = follow(stages, state, time)
        # A switch may be followed by another at the same instant: nothing happens in between.
        phases += [phase] if phase.end > phase.start else []
        if switch is None or phase.end >= end_time:
            return tuple(phases)
        time = phase.end
        stages, state = after(equations, stages, switch, phase.states[:, -1])
    raise NotReached(f"more than {MOST_SWITCHES} switches of contact before t = {time:.6g} s; cure: lower end_time")
