"""Where a level dips through zero and comes back between two rows: what integration by steps would step over."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Level = Callable[[Array], Array]
# A slope is a difference over this share of the longest row.
NEAR = 1e-4


class Graze(NamedTuple):
    """Which level falls through zero first, and when, s."""

    level: int
    time: float


def first_graze(
    levels: list[Level], times: Array, states: Array, rates: Callable[[Array], Array], at: Callable[[float], Array]
) -> Graze | None:
    """The first dip below zero of levels that are above it at both neighbouring rows; None without one.

    `times` (k,), `states` (size, k); `rates` maps states to their rates, `at` a time inside to the state there. A
    level's lowest place between two rows is where its slope changes sign; rows are so close that it does so once.
    """
    if times[-1] == times[0]:  # a phase that a switch ends at once
        return None
    rows = Rows(times, states, rates, at)
    found = [rows.dip(level) for level in levels]
    dips = [Graze(index, time) for index, time in enumerate(found) if time is not None]
    return min(dips, key=lambda dip: dip.time) if dips else None


class Rows(NamedTuple):
    """A phase as :func:`first_graze` is given it."""

    times: Array
    states: Array
    rates: Callable[[Array], Array]
    at: Callable[[float], Array]

    def slope(self, level: Level, states: Array) -> Array:
        """The rate of a level at states (size, ...), per s."""
        near = NEAR * float(np.diff(self.times).max())
        ahead = near * self.rates(states)
        return np.asarray((level(states + ahead) - level(states - ahead)) / (2.0 * near))

    def dip(self, level: Level) -> float | None:
        """When one level falls through zero in its first dip, s."""
        from scipy.optimize import brentq

        values, slopes, lengths = np.asarray(level(self.states)), self.slope(level, self.states), np.diff(self.times)
        falling, rising = slopes[:-1], slopes[1:]
        dips = (falling < 0.0) & (rising > 0.0) & (values[:-1] > 0.0) & (values[1:] > 0.0)
        # A curve that turns once lies above where its two tangents meet.
        meet = (values[1:] - values[:-1] - rising * lengths) / np.where(dips, falling - rising, 1.0)
        for i in np.flatnonzero(dips & (values[:-1] + falling * meet <= 0.0)):
            span = float(self.times[i]), float(self.times[i + 1])
            lowest = brentq(lambda time: float(self.slope(level, self.at(time))), *span)
            if float(level(self.at(lowest))) < 0.0:
                return float(brentq(lambda time: float(level(self.at(time))), span[0], lowest, xtol=1e-300, rtol=1e-14))
        return None
