"""Exponent 1: between two switches the motion is linear, and its matrix exponential is exact to rounding.

The exponential of small matrices, many at once, without the threads that a library's solver starts for each.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from math import ceil, log2

import numpy as np
from numpy.typing import NDArray

from lumped.ptmd.equations import SURFACES, Equations, Stages, Switch, switches
from lumped.ptmd.phase import Follow, LevelRow, PtmdPhase, first_row
from lumped.ptmd.system import Start

Array = NDArray[np.float64]
MOST_ROWS = 300_000  # some twenty seconds
BLOCK = 64  # work: rows propagated at once
LEAST_SHARE = 0.01  # of the spacing: a row nearer to the start of a phase would show nothing but rounding
SERIES_TERMS, SERIES_REACH = 18, 0.25  # rounding: terms of the integral's series, and the norm up to which they suffice
ROUNDING = 1e-13  # rounding: of a level's parts, where a phase begins
REACH, TERMS = 0.5, 15  # the series leaves out 0.5^16/16!


@dataclass(frozen=True, eq=False)
class Flow:
    """The linear motion with certain stages: dy/dt = matrix y; rows `spacing` apart, s."""

    equations: Equations
    stages: Stages
    spacing: float

    @cached_property
    def _linear(self) -> tuple[Array, Array]:
        moving = self.equations.moving(self.stages, np.eye(self.equations.size))
        rates, integrands = self.equations.linear_forms(self.stages)
        return rates @ moving, moving.T @ integrands @ moving

    @property
    def matrix(self) -> Array:
        """Shape (size, size)."""
        return self._linear[0]

    @property
    def forms(self) -> Array:
        """The integrands as quadratic forms, shape (6, size, size)."""
        return self._linear[1]

    @cached_property
    def switches(self) -> tuple[Switch, ...]:
        """What can end this motion."""
        return switches(self.equations, self.stages)

    @cached_property
    def levels(self) -> tuple[Array, Array]:
        """The levels of the switches as affine functions of the state: rows, shape (m, size), and constants (m,)."""
        size = self.equations.size
        constants = np.array([switch.level(np.zeros(size)) for switch in self.switches])
        rows = np.array([switch.level(np.eye(size)) for switch in self.switches]).reshape(-1, size)
        return rows - constants[:, None], constants

    def propagator(self, time: float | Array) -> Array:
        """exp(matrix t), shape (..., size, size)."""
        scales, balanced = self.scales, self.balanced
        return exponential(balanced * np.asarray(time)[..., None, None]) / scales * scales[:, None]

    @cached_property
    def scales(self) -> Array:
        """Units of the numbers of a state in which velocities are per row, not per second."""
        scales = np.ones(self.equations.size)
        scales[1:SURFACES:2] = 1.0 / self.spacing
        return scales

    @cached_property
    def balanced(self) -> Array:
        """The matrix in these units: no entry is large only because of its unit."""
        return self.matrix * self.scales / self.scales[:, None]

    @cached_property
    def powers(self) -> Array:
        """Propagators over 1 to BLOCK rows."""
        return self.propagator(self.spacing * np.arange(1.0, BLOCK + 1.0))

    @cached_property
    def gramian(self) -> Array:
        """`integral_forms` over one row."""
        return self.integral_forms(self.spacing)

    def integral_forms(self, time: float) -> Array:
        """Forms W with int_0^t integrand ds = y W y, y the state at the start, shape (6, size, size).

        A power series over t/2^k, then W(2t) = W(t) + P(t)^T W(t) P(t).
        """
        matrix, forms = self.balanced, self.forms * self.scales * self.scales[:, None]
        reach = float(np.abs(matrix).sum(axis=1).max()) * time
        doublings = max(0, ceil(log2(reach / SERIES_REACH))) if reach > 0.0 else 0
        step = time * 0.5**doublings
        term = step * forms
        total = term
        for order in range(2, SERIES_TERMS):
            left = matrix.T @ term
            term = (left + np.swapaxes(left, 1, 2)) * step / order
            total = total + term
        over = exponential(matrix * step)
        for _ in range(doublings):
            total, over = total + over.T @ total @ over, over @ over
        return np.asarray(total / self.scales / self.scales[:, None])

    def integrals(self, times: Array, states: Array) -> Array:
        """Integrals from the first to the last of rows of which all but the outermost lie `spacing` apart, (6,)."""
        outer = {0, times.size - 2}
        total = sum(_squares(self.integral_forms(times[i + 1] - times[i]), states[:, [i]]) for i in outer if i >= 0)
        return np.asarray(total + _squares(self.gramian, states[:, 1 : max(times.size - 2, 1)]))


def _squares(forms: Array, states: Array) -> Array:
    """Sum over the columns y of y W y, shape (6,)."""
    return np.tensordot(forms, states @ states.T, 2)


def route(equations: Equations, _: Start, spacing: float, end_time: float) -> Follow:
    """How a phase is followed: each motion's exponentials are found once."""
    flows: dict[Stages, Flow] = {}

    def next_phase(stages: Stages, state: Array, time: float) -> tuple[PtmdPhase, Switch | None]:
        flow = flows.setdefault(stages, Flow(equations, stages, spacing))
        return follow(flow, state, time, end_time)

    return next_phase


def first_of(
    flow: Flow, time: float, state: Array, times: Array, states: Array, fresh: bool
) -> tuple[float, int, Array] | None:
    """When, s, the first level falls, which one, and the state there, (size,); None where none does.

    Between `time` and the rows `times`, (k,), with states (size, k). `fresh`: a phase has just begun, so a level may
    start at zero.
    """
    rows, constants = flow.levels
    rates = rows @ flow.matrix
    times, states = np.append(time, times), np.concatenate([state[:, None], states], axis=1)
    levels, lengths = rows @ states + constants[:, None], np.diff(times)
    # Where a phase begins no level lies below zero, but for the rounding of the switch before.
    begun = fresh & (levels[:, 0] <= ROUNDING * (np.abs(rows) @ np.abs(state) + np.abs(constants)))

    def between(i: int) -> list[LevelRow]:
        def at(offset: float) -> Array:
            return np.asarray(flow.propagator(offset) @ states[:, i])

        return [
            LevelRow(_affine(row, constant), _affine(rate, 0.0), at, float(lengths[i]))
            for row, constant, rate in zip(rows, constants.tolist(), rates, strict=True)
        ]

    found = first_row(lengths, levels, rates @ states, begun, between)
    if found is None:
        return None
    i, offset, level = found
    return float(times[i]) + offset, level, flow.propagator(offset) @ states[:, i]


def _affine(row: Array, constant: float) -> Callable[[Array], float]:
    return lambda y: float(row @ y + constant)


def follow(flow: Flow, state: Array, time: float, end_time: float) -> tuple[PtmdPhase, Switch | None]:
    """One phase, and the switch that ends it; None at `end_time`."""
    times, columns, switch = [np.array([time])], [state[:, None]], None
    for block_times, block in _blocks(flow, state, time, end_time):
        found = first_of(flow, times[-1][-1], columns[-1][:, -1], block_times, block, fresh=len(times) == 1)
        if found is None:
            times.append(block_times)
            columns.append(block)
            continue
        end, level, last = found
        inside = block_times < end
        times += [block_times[inside], np.array([end])]
        columns += [block[:, inside], last[:, None]]
        switch = flow.switches[level]
        break
    return _phase(flow, np.concatenate(times), np.concatenate(columns, axis=1)), switch


def _blocks(flow: Flow, state: Array, time: float, end_time: float) -> Iterator[tuple[Array, Array]]:
    """Rows after `time`: on whole multiples of the spacing, and at `end_time`."""
    count = int(time / flow.spacing + LEAST_SHARE) + 1
    while count * flow.spacing < end_time:
        ahead = min(BLOCK, ceil(end_time / flow.spacing) - count)
        first = flow.propagator(count * flow.spacing - time) @ state
        block = np.concatenate([first[None], flow.powers[: ahead - 1] @ first])
        yield np.asarray(flow.spacing * np.arange(count, count + ahead)), block.T
        count, time, state = count + ahead, flow.spacing * (count + ahead - 1), block[-1]
    yield np.array([end_time]), (flow.propagator(end_time - time) @ state)[:, None]


def _phase(flow: Flow, times: Array, states: Array) -> PtmdPhase:
    def at(time: float) -> Array:
        i = int(np.clip(np.searchsorted(times, time, side="right") - 1, 0, times.size - 1))
        return np.asarray(flow.propagator(time - times[i]) @ states[:, i])

    def integrals(time: float) -> Array:
        before = times < time
        return flow.integrals(np.append(times[before], time), states[:, before]) if before.any() else np.zeros(6)

    return PtmdPhase(flow.stages, times, states, at, integrals)


def exponential(matrices: Array) -> Array:
    """exp of each of (..., n, n): Taylor series of the matrix over 2^k, squared k times.

    What is squared is exp - 1, (1 + e)^2 - 1 = 2 e + e^2: beside the unit matrix small numbers would lose their digits.
    """
    norm = float(np.abs(matrices).sum(axis=-1).max())
    squarings = max(0, ceil(log2(norm / REACH))) if norm > 0.0 else 0
    scaled, unit = matrices * 0.5**squarings, np.eye(matrices.shape[-1])
    rest = scaled / TERMS
    for term in range(TERMS - 1, 0, -1):
        rest = (scaled + scaled @ rest) / term
    for _ in range(squarings):
        rest = 2.0 * rest + rest @ rest
    return np.asarray(unit + rest)
