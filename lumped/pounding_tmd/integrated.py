"""Any exponent: an adaptive integration of order 8 between the switches; for exponent 1 a check of the exact route."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumped.errors import NotReached
from lumped.pounding_tmd.crossing import first_fall, suspect
from lumped.pounding_tmd.equations import Equations, Stages
from lumped.pounding_tmd.phase import Follow, Phase, fastest
from lumped.pounding_tmd.switches import Switch, switches
from lumped.pounding_tmd.system import Start

Array = NDArray[np.float64]
RTOL, ATOL = 1e-12, 1e-14  # the second relative to the largest values that the energy of the start allows
MOST_ROWS = 30_000  # some minutes: each is a step of twelve stages, and more where a switch is located
INTEGRALS = 6
NEAR = 1e-4  # of the longest step: a slope is a difference over it
BEGUN = 1e-9  # of the change in a step: where time is long beside a step, a switch lies no nearer to zero


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

    def rate(_: float, y: Array) -> Array:
        return np.concatenate([equations.rates(stages, y[:size]), equations.integrands(stages, y[:size])])

    stepper: Any = integrate.DOP853  # its stubs know only their own array shapes
    solver = stepper(
        rate, span[0], np.concatenate([state, np.zeros(INTEGRALS)]), span[1],
        rtol=RTOL, atol=ATOL * scales, max_step=spacing,
    )  # fmt: skip
    levels = [Level(switch.level, lambda y: equations.rates(stages, y), NEAR * spacing) for switch in known]
    times, states, pieces, switch = [span[0]], [solver.y], [], None
    before = _asked(levels, state, solver.f[:size])
    while solver.status == "running" and switch is None:
        message = solver.step()
        if solver.status == "failed":
            raise NotReached(f"the integration stopped: {message}")
        pieces.append(solver.dense_output())
        after = _asked(levels, solver.y[:size], solver.f[:size])
        end = solver.t
        fall = _fall(levels, pieces[-1], np.stack([before, after]), fresh=len(pieces) == 1)
        if fall is not None:
            end, switch = times[-1] + fall[0], known[fall[1]]
        if end > times[-1]:
            times.append(end)
            states.append(pieces[-1](end) if switch else solver.y)
        before = after
    return _phase(stages, np.array(times), np.column_stack(states), pieces, size), switch


class Level(NamedTuple):
    """A level as a function of states, with `rates` of states; a slope is a difference over `near`, s, both ways."""

    of: Callable[[Array], Array]
    rates: Callable[[Array], Array]
    near: float

    def slope(self, y: Array, rates: Array) -> float:
        """Its rate at a state of these rates."""
        ahead = self.near * rates
        return float(self.of(y + ahead) - self.of(y - ahead)) / (2.0 * self.near)


class LevelRow(NamedTuple):
    """A level over one step, from its interpolant; `length` in s."""

    level: Level
    piece: Any
    length: float

    def value(self, offset: float) -> float:
        """The level."""
        return float(self.level.of(self._at(offset)))

    def slope(self, offset: float) -> float:
        """Its rate."""
        y = self._at(offset)
        return self.level.slope(y, self.level.rates(y))

    def _at(self, offset: float) -> Array:
        return np.asarray(self.piece(self.piece.t_old + offset)[:-INTEGRALS])


def _asked(levels: list[Level], y: Array, rates: Array) -> Array:
    """Every level and its slope at a state, shape (2, m)."""
    return np.array([[float(level.of(y)) for level in levels], [level.slope(y, rates) for level in levels]])


def _fall(levels: list[Level], piece: Any, ends: Array, fresh: bool) -> tuple[float, int] | None:
    """Offset, s, and index of the first fall within a step; `ends` (2, 2, m): level and slope before and after it."""
    length = float(piece.t - piece.t_old)
    values, slopes = ends[:, 0].T, ends[:, 1].T
    # Where a phase begins no level lies below zero, but for the rounding of the switch before.
    begun = fresh & (values[:, 0] <= BEGUN * length * np.abs(slopes).max(axis=1, initial=0.0))
    if not begun.any() and not suspect(np.array([length]), values, slopes).any():
        return None
    return first_fall([LevelRow(level, piece, length) for level in levels], begun.tolist())


def _phase(stages: Stages, times: Array, states: Array, pieces: list[Any], size: int) -> Phase:
    def solution(time: float) -> Array:
        i = int(np.clip(np.searchsorted(times, time, side="right") - 1, 0, len(pieces) - 1))
        return np.asarray(pieces[i](time))

    def at(time: float) -> Array:
        return solution(time)[:size]

    def integrals(time: float) -> Array:
        return solution(time)[size:]

    return Phase(stages, times, states[:size], at, integrals)


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
