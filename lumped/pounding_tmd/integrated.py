"""Any exponent: an adaptive integration of order 8 between the switches; for exponent 1 a check of the exact route."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lumped.errors import NotReached
from lumped.pounding_tmd.equations import Equations, Stages
from lumped.pounding_tmd.graze import NEAR, first_graze
from lumped.pounding_tmd.phase import Follow, Phase, fastest
from lumped.pounding_tmd.switches import Switch, switches
from lumped.pounding_tmd.system import Start

Array = NDArray[np.float64]
RTOL, ATOL = 1e-12, 1e-14  # the second relative to the largest values that the energy of the start allows
INTEGRALS = 6
TINY = 1e-300


def route(equations: Equations, start: Start, spacing: float, end_time: float) -> Follow:
    """How a phase is followed, in steps no longer than `spacing`, s."""
    scales = _scales(equations, start)

    def next_phase(stages: Stages, state: Array, time: float) -> tuple[Phase, Switch | None]:
        return _follow(equations, stages, state, (time, end_time), spacing, scales)

    return next_phase


def _follow(
    equations: Equations, stages: Stages, state: Array, span: tuple[float, float], spacing: float, scales: Array
) -> tuple[Phase, Switch | None]:
    """One phase, and the switch that ends it; None at the end of the span. The integrals are states too."""
    from scipy import integrate

    size, known = equations.size, switches(equations, stages)
    ahead = state + NEAR * spacing * equations.rates(stages, state)
    events = [_terminal(switch.level, size, span[0], float(switch.level(ahead)) > 0.0) for switch in known]

    def rate(_: float, y: Array) -> Array:
        return np.concatenate([equations.rates(stages, y[:size]), equations.integrands(stages, y[:size])])

    solve_ivp: Any = integrate.solve_ivp  # its stubs know only their own array shapes
    solution = solve_ivp(
        rate, span, np.concatenate([state, np.zeros(INTEGRALS)]), method="DOP853", rtol=RTOL, atol=ATOL * scales,
        max_step=spacing, dense_output=True, events=events or None,
    )  # fmt: skip
    if solution.status < 0:
        raise NotReached(f"the integration stopped: {solution.message}")
    fallen = [i for i, hits in enumerate(solution.t_events or []) if hits.size]
    phase = _phase(stages, solution, size)
    levels = [switch.level for switch in known]
    graze = first_graze(levels, phase.times, phase.states, lambda y: equations.rates(stages, y), phase.at)
    if graze is not None:
        return _cut(phase, graze.time), known[graze.level]
    return phase, known[fallen[0]] if fallen else None


def _cut(phase: Phase, end: float) -> Phase:
    """The phase up to a time, s."""
    kept = phase.times < end
    states = np.column_stack([phase.states[:, kept], phase.at(end)])
    return replace(phase, times=np.append(phase.times[kept], end), states=states)


def _phase(stages: Stages, solution: Any, size: int) -> Phase:
    def at(time: float) -> Array:
        return np.asarray(solution.sol(time)[:size])

    def integrals(time: float) -> Array:
        return np.asarray(solution.sol(time)[size:])

    return Phase(stages, solution.t, solution.y[:size], at, integrals)


def _scales(equations: Equations, start: Start) -> Array:
    """Size of each number of the state and of each integral, shape (size + 6,)."""
    y, omega = equations.initial(start), fastest(equations, start)
    energy = equations.kinetic(y) + equations.potential(y)
    length = float(np.sqrt(2.0 * energy / equations.system.structure.stiffness))
    exponent = equations.system.ring.exponent if equations.system.ring else 1.0
    bodies = [length, omega * length] * (2 if equations.system.damper else 1)
    surfaces = [length**exponent] * (equations.size - len(bodies))
    squares = [length**2 / omega, omega**3 * length**2]
    return np.array([*bodies, *surfaces, *squares, *[energy] * (INTEGRALS - len(squares))])


def _terminal(level: Callable[[Array], Array], size: int, start: float, rises: bool) -> Callable[[float, Array], float]:
    """The level in scipy's manner: attributes of the function say that it ends the run, and only falling.

    `rises`: from the start on. Then a fall within the first step is not that at the start.
    """
    least = TINY if rises else 0.0

    def marked(time: float, y: Array) -> float:
        # No level is below zero when a phase begins; what rounding says there would hide a fall from zero.
        return max(float(level(y[:size])), least) if time == start else float(level(y[:size]))

    marked.terminal = True  # type: ignore[attr-defined]
    marked.direction = -1.0  # type: ignore[attr-defined]
    return marked
