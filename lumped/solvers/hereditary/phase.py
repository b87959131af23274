"""A part of an impact as a function of time, whatever its path runs over."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from lumped.solvers.hereditary.path import Path

Array = NDArray[np.float64]
NEWTON_STEPS, ENDS = 4, 34


class PathClock(Protocol):
    """Times of places and places of times, arrays of one shape."""

    def time(self, places: Array) -> Array:
        """Times, ascending with the places."""

    def place(self, times: Array) -> Array:
        """The places at these times."""


class SinceTouch:
    """Places are roots of the time."""

    def time(self, places: Array) -> Array:
        return places * places

    def place(self, times: Array) -> Array:
        return np.sqrt(times)


@dataclass(frozen=True)
class UntilEnd:
    """Places are roots of the time left until `end`, negative."""

    end: float

    def time(self, places: Array) -> Array:
        return self.end - places * places

    def place(self, times: Array) -> Array:
        return np.asarray(-np.sqrt(np.maximum(self.end - times, 0.0)))


@dataclass(frozen=True, eq=False)
class ByField:
    """The time is field 0 of the path itself, which ascends, at its ends perhaps as a square."""

    path: Path

    def time(self, places: Array) -> Array:
        return self.path.field(0, places)[0]

    def place(self, times: Array) -> Array:
        """Newton's steps from a table, within its intervals."""
        known, table = self._table
        i = np.clip(np.searchsorted(table, times), 1, known.size - 1)
        low, high, rise = known[i - 1], known[i], table[i] - table[i - 1]
        share = np.divide(times - table[i - 1], rise, out=np.zeros_like(rise), where=rise > 0.0)
        place = low + (high - low) * np.clip(share, 0.0, 1.0)
        for _ in range(NEWTON_STEPS):
            time, slope = self.path.field(0, place)
            step = np.divide(times - time, slope, out=np.zeros_like(time), where=slope > 0.0)
            place = np.minimum(np.maximum(place + step, low), high)
        return np.asarray(place)

    @cached_property
    def _table(self) -> tuple[Array, Array]:
        """Places and their times, towards the ends so dense that every interval doubles the distance to them."""
        places = self.path.places
        shares = 0.5 ** np.arange(4.0, ENDS)
        length = places[-1] - places[0]
        known = np.unique(np.concatenate([places, places[0] + length * shares, places[-1] - length * shares]))
        return known, np.maximum.accumulate(self.time(known))


@dataclass(frozen=True, eq=False)
class HereditaryPhase:
    """A path and its clock; `depth` is the first of its fields depth, velocity, work, force, and of the edge's.

    The edge's field is the depth at which an elastic contact would have the present radius.
    """

    path: Path
    clock: PathClock
    depth: int
    edge: int

    @cached_property
    def times(self) -> Array:
        """Times that lie densely, shape (n,)."""
        return self.clock.time(self.path.places)

    @property
    def last(self) -> Array:
        """Depth, velocity, work and force at its end."""
        return self.path.state(self.path.end)[self.depth : self.depth + 4]

    def at(self, times: Array) -> Array:
        """Depth, velocity, force and the edge's depth at times (n,), shape (4, n)."""
        return self._seen.at(self._places(times))

    def force(self, times: Array) -> Array:
        """The force at times (n,)."""
        return self.path.value(self.depth + 3, self._places(times))

    def _places(self, times: Array) -> Array:
        return np.minimum(self.clock.place(times), self.path.end)

    @cached_property
    def _seen(self) -> Path:
        return self.path.of_fields([self.depth, self.depth + 1, self.depth + 3, self.edge])

    def highest(self, field: int) -> tuple[float, float]:
        """When a field is highest, 0 the depth and 3 the force, and how high."""
        place, height = self.path.highest(self.depth + field)
        return float(self.clock.time(np.array([place]))[0]), height
