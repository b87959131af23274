"""Any exponent: an adaptive integration of order 8 between the switches; for exponent 1 a check of the exact route."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from lumped.errors import NotReached
from lumped.ptmd.equations import Equations, SideStage, Stages, Switch, switches
from lumped.ptmd.phase import Follow, LevelRow, PtmdPhase, fastest, first_row
from lumped.ptmd.system import Start

Array = NDArray[np.float64]
RTOL, ATOL = 1e-12, 1e-14  # the second relative to the largest values that the energy of the start allows
MOST_ROWS = 30_000  # some minutes: each is a step of twelve stages, and more where a switch is located
INTEGRALS = 6  # energies and squares that are integrated beside the state
NEAR = 1e-4  # of the longest step: a slope is a difference over it
BEGUN = 1e-9  # of the change in a step: where time is long beside a step, a switch lies no nearer to zero


@dataclass(frozen=True)
class Rates:
    """The rates of a state and of the integrals beside it while both sides do this: products with known matrices."""

    equations: Equations
    stages: Stages

    @cached_property
    def _driven(self) -> list[int]:
        return self.equations.driven(self.stages)

    @cached_property
    def _forms(self) -> tuple[Array, Array]:
        """Rates and integrands of what `_moving` gives."""
        matrix, forms = self.equations.linear_forms(self.stages)
        return (matrix, forms) if self._driven else (matrix @ self._followed, self._followed.T @ forms @ self._followed)

    @cached_property
    def _followed(self) -> Array:
        """The linear part of `Equations.moving`, shape (size + 2, size)."""
        stages = tuple(SideStage.HELD if index in self._driven else stage for index, stage in enumerate(self.stages))
        return self.equations.moving(stages, np.eye(self.equations.size))

    def _moving(self, y: Array) -> Array:
        """As `Equations.moving`, and where all is linear the state itself."""
        if not self._driven:
            return y
        found = self._followed @ y
        for index in self._driven:
            found[self.equations.side(index).start] = self.equations.place(index, y)
            found[self.equations.size + index] = self.equations.speed(index, self.stages[index], y)
        return found

    def of(self, y: Array) -> Array:
        """dy/dt, shape (size,)."""
        return np.asarray(self._forms[0] @ self._moving(y))

    def __call__(self, _: float, y: Array) -> Array:
        """Of a state followed by its integrals, shape (size + 6,)."""
        matrix, forms = self._forms
        moving = self._moving(y[: matrix.shape[0]])
        return np.concatenate([matrix @ moving, forms @ moving @ moving])


def route(equations: Equations, start: Start, spacing: float, end_time: float) -> Follow:
    """How a phase is followed, in steps no longer than `spacing`, s; longer ones where nothing presses the ring."""
    scales, known = _scales(equations, start), dict[Stages, Rates]()
    ringless = Equations(replace(equations.system, ring=None))
    flying = spacing * fastest(equations, start) / fastest(ringless, start)

    def next_phase(stages: Stages, state: Array, time: float) -> tuple[PtmdPhase, Switch | None]:
        rates = known.setdefault(stages, Rates(equations, stages))
        longest = spacing if SideStage.PRESSED in stages else flying
        return _follow(rates, state, (time, end_time), longest, scales)

    return next_phase


def _follow(
    rates: Rates, state: Array, span: tuple[float, float], spacing: float, scales: Array
) -> tuple[PtmdPhase, Switch | None]:
    """One phase, and the switch that ends it; None at the end of the span. The integrals are states too."""
    from scipy import integrate

    size, known = rates.equations.size, switches(rates.equations, rates.stages)
    stepper: Any = integrate.DOP853  # its stubs know only their own array shapes
    solver = stepper(
        rates, span[0], np.concatenate([state, np.zeros(INTEGRALS)]), span[1],
        rtol=RTOL, atol=ATOL * scales, max_step=spacing,
    )  # fmt: skip
    levels = [PtmdLevel(switch.level, rates.of, NEAR * spacing) for switch in known]
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
    return _phase(rates.stages, np.array(times), np.column_stack(states), pieces, size), switch


class PtmdLevel(NamedTuple):
    """A level as a function of states, with `rates` of states; a slope is a difference over `near`, s, both ways."""

    of: Callable[[Array], Array]
    rates: Callable[[Array], Array]
    near: float

    def value(self, y: Array) -> float:
        """It at a state."""
        return float(self.of(y))

    def own_slope(self, y: Array) -> float:
        """Its rate at a state."""
        return self.slope(y, self.rates(y))

    def slope(self, y: Array, rates: Array) -> float:
        """Its rate at a state of these rates."""
        ahead = self.near * rates
        return float(self.of(y + ahead) - self.of(y - ahead)) / (2.0 * self.near)


class _Piece(Protocol):
    """What an integrator knows of one step, from `t_old` to `t`, s: the state at its times."""

    t_old: float
    t: float

    def __call__(self, time: float) -> Array: ...


def _asked(levels: list[PtmdLevel], y: Array, rates: Array) -> Array:
    """Every level and its slope at a state, shape (2, m)."""
    return np.array([[level.value(y) for level in levels], [level.slope(y, rates) for level in levels]])


def _fall(levels: list[PtmdLevel], piece: _Piece, ends: Array, fresh: bool) -> tuple[float, int] | None:
    """Offset, s, and index of the first fall within a step; `ends` (2, 2, m): level and slope before and after it."""
    length = float(piece.t - piece.t_old)
    values, slopes = ends[:, 0].T, ends[:, 1].T
    # Where a phase begins no level lies below zero, but for the rounding of the switch before.
    begun = fresh & (values[:, 0] <= BEGUN * length * np.abs(slopes).max(axis=1, initial=0.0))

    def at(offset: float) -> Array:
        return np.asarray(piece(piece.t_old + offset)[:-INTEGRALS])

    # the interpolant is asked for times, s, not for offsets
    resolution = float(np.spacing(piece.t))
    rows = [LevelRow(level.value, level.own_slope, at, length, resolution) for level in levels]
    found = first_row(np.array([length]), values, slopes, begun, lambda _: rows)
    return found and found[1:]


def _phase(stages: Stages, times: Array, states: Array, pieces: list[_Piece], size: int) -> PtmdPhase:
    def solution(time: float) -> Array:
        i = int(np.clip(np.searchsorted(times, time, side="right") - 1, 0, len(pieces) - 1))
        return np.asarray(pieces[i](time))

    def at(time: float) -> Array:
        return solution(time)[:size]

    def integrals(time: float) -> Array:
        return solution(time)[size:]

    return PtmdPhase(stages, times, states[:size], at, integrals)


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
