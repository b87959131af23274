"""Where a level of the exact motion falls through zero first: found between rows, located to rounding."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from lumped.pounding_tmd.exact import Flow

Array = NDArray[np.float64]
ROUNDING = 1e-13
NEAREST = 40  # halvings of a row in which a contact that has just begun is looked for


@dataclass(frozen=True)
class Fall:
    """Which level falls through zero, when, s, and the state there, shape (size,)."""

    level: int
    time: float
    state: Array


def first_fall(flow: Flow, time: float, state: Array, times: Array, states: Array, fresh: bool) -> Fall | None:
    """The first fall between `time` and the rows `times`, (k,), with states (size, k); None without one.

    `fresh`: a phase has just begun, so a level may start at zero.
    """
    rows, constants = flow.levels
    times, states = np.append(time, times), np.concatenate([state[:, None], states], axis=1)
    levels, slopes = rows @ states + constants[:, None], rows @ flow.matrix @ states
    # Where a phase begins no level lies below zero, but for the rounding of the switch before.
    begun = (levels[:, 0] <= ROUNDING * (np.abs(rows) @ np.abs(state) + np.abs(constants))) & fresh
    for i in np.flatnonzero(_suspect(times, levels, slopes, begun)):
        falls = []
        for level in range(constants.size):
            segment = _Segment(flow, level, states[:, i], float(times[i + 1] - times[i]))
            offset = segment.from_zero() if begun[level] and i == 0 else segment.from_above()
            if offset is not None:
                falls.append((offset, level))
        if falls:
            offset, level = min(falls)
            return Fall(level, float(times[i]) + offset, flow.propagator(offset) @ states[:, i])
    return None


def _suspect(times: Array, levels: Array, slopes: Array, begun: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Intervals between rows in which some level may fall: it ends below, dips in between, or starts at zero."""
    below = levels[:, 1:] <= 0.0
    turns = (slopes[:, :-1] < 0.0) & (slopes[:, 1:] > 0.0)
    near = levels[:, :-1] + 2.0 * slopes[:, :-1] * np.diff(times) <= 0.0
    suspect = np.asarray(np.any(below | (turns & near), axis=0))
    suspect[0] |= bool(begun.any())
    return suspect


@dataclass(frozen=True)
class _Segment:
    """One level between two rows: `state` at the first, `length` seconds to the second."""

    flow: Flow
    level: int
    state: Array
    length: float

    def value(self, offset: float) -> float:
        """The level."""
        rows, constants = self.flow.levels
        return float(rows[self.level] @ (self.flow.propagator(offset) @ self.state) + constants[self.level])

    def slope(self, offset: float) -> float:
        """Its rate."""
        row = self.flow.levels[0][self.level] @ self.flow.matrix
        return float(row @ (self.flow.propagator(offset) @ self.state))

    def from_above(self) -> float | None:
        """Offset of the first fall of a level that starts above zero."""
        if self.value(self.length) <= 0.0:
            return _root(self.value, 0.0, self.length)
        if not self.slope(0.0) < 0.0 < self.slope(self.length):
            return None
        lowest = _root(self.slope, 0.0, self.length)
        return _root(self.value, 0.0, lowest) if self.value(lowest) < 0.0 else None

    def from_zero(self) -> float | None:
        """Offset of the first fall of a level that starts at zero: none, at once, or after a short rise."""
        row = self.flow.levels[0][self.level] @ self.flow.matrix
        if self.slope(0.0) < -ROUNDING * float(np.abs(row) @ np.abs(self.state)):
            return 0.0
        offset = self.length
        for _ in range(NEAREST):
            if self.value(offset) > 0.0:
                return None if offset == self.length else _root(self.value, offset, 2.0 * offset)
            offset *= 0.5
        return 0.0


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    from scipy.optimize import brentq

    if function(low) == 0.0:
        return low
    return float(brentq(function, low, high, xtol=1e-300, rtol=1e-14))
