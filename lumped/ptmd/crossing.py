"""Where a level falls through zero between two rows of a motion, by either route.

What is asked is the sign of a level at its located lowest place or at the end of a row. No sign is asked where a level
is zero but for rounding: there its slope says where it goes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
NEAREST = 40  # halvings of a row in which a contact that has just begun is looked for
STILL = 1e-7  # of the steepest slope of a row: less takes a level 1e-14 of its change below zero, which is rounding


class PtmdRow(Protocol):
    """One level from one row to the next, `length` s later, at any `offset` between them, s."""

    @property
    def length(self) -> float: ...

    @property
    def resolution(self) -> float:
        """Offsets closer than this, s, have one value."""

    def value(self, offset: float) -> float: ...

    def slope(self, offset: float) -> float: ...


def suspect(lengths: Array, levels: Array, slopes: Array) -> Flags:
    """Rows, shape (k,), in which a level may fall: it ends at or below zero, or it dips and comes back.

    `levels` and `slopes`, shape (m, k + 1), where the rows begin and end.
    """
    below = levels[:, 1:] <= 0.0
    turns = (slopes[:, :-1] < 0.0) & (slopes[:, 1:] > 0.0)
    near = levels[:, :-1] + 2.0 * slopes[:, :-1] * lengths <= 0.0
    return np.asarray(np.any(below | (turns & near), axis=0))


def first_fall(rows: Sequence[PtmdRow], begun: Sequence[bool]) -> tuple[float, int] | None:
    """Offset, s, and index of the level that falls first; None where none does.

    `begun`: a phase begins here and the level is zero, but for the rounding of the switch before.
    """
    found = [_from_zero(row) if zero else _from_above(row) for row, zero in zip(rows, begun, strict=True)]
    return min(((offset, index) for index, offset in enumerate(found) if offset is not None), default=None)


def _from_above(row: PtmdRow) -> float | None:
    """Offset of the first fall of a level that starts above zero. Rows are so close that it turns but once."""
    if row.value(row.length) <= 0.0:
        return _root(row, row.value, 0.0, row.length)
    if not row.slope(0.0) < 0.0 < row.slope(row.length):
        return None
    lowest = _root(row, lambda offset: -row.slope(offset), 0.0, row.length)
    return _root(row, row.value, 0.0, lowest) if row.value(lowest) < 0.0 else None


def _from_zero(row: PtmdRow) -> float | None:
    """Offset of the first fall of a level that starts at zero: none, at once, or after a rise, however short."""
    start, end = row.slope(0.0), row.slope(row.length)
    if start < -STILL * max(abs(start), abs(end)):
        return 0.0
    offset = row.length
    for _ in range(NEAREST):
        if row.value(offset) > 0.0:
            return None if offset == row.length else _root(row, row.value, offset, 2.0 * offset)
        offset *= 0.5
    return 0.0


def _root(row: PtmdRow, function: Callable[[float], float], low: float, high: float) -> float:
    """Where a function falls through zero that is above it at `low` and not at `high`, as far as rounding lets it."""
    from scipy.optimize import brentq

    if function(low) <= 0.0:
        return low
    if function(high) >= 0.0:
        return high
    # Below the resolution a function is a staircase, on which the search would halve without end.
    return float(brentq(function, low, high, xtol=max(row.resolution, 1e-300), rtol=1e-14))
