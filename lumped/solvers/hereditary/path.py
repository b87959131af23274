"""A solution in pieces, each a polynomial of every field of its state; as a function of time, whatever it runs over."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.polynomial import chebyshev as polynomial
from numpy.typing import NDArray

from lumped.numbers import Array, falling_zero
from lumped.solvers.radau import chebyshev_through_zero

Curve = Callable[[float], float]
# Shares of a piece that lie densely, and those between which a fall is sought.
DENSE, CLOSE = np.linspace(0.0, 1.0, 25), np.linspace(0.0, 1.0, 65)
# Work: so many places, and pieces, are few.
FEW, FEW_PIECES = 100, 8
# Work: steps that place a time within its interval; rounding: halvings towards both ends in the table of times.
NEWTON_STEPS, ENDS = 4, 34


@dataclass(frozen=True, eq=False)
class Path:
    """`breaks` (m+1,) ascend; `coefficients` (m, fields, N+1) are those of Chebyshev polynomials in each piece.

    `end` is the last place, at most the last break: what lies beyond an event is no part of the path.
    """

    breaks: Array
    coefficients: Array
    end: float

    @classmethod
    def of(cls, breaks: Sequence[float], values: Sequence[Array]) -> Path:
        """The path through `values`, for every piece (fields, N+1) at its first place and its nodes."""
        series = chebyshev_through_zero(values[0].shape[1] - 1)
        return cls(np.array(breaks), np.array(values) @ series.T, float(breaks[-1]))

    def joined(self, later: Path) -> Path:
        """The path, whole, and one that goes on from its last break."""
        breaks = np.append(self.breaks, later.breaks[1:])
        return Path(breaks, np.concatenate([self.coefficients, later.coefficients]), later.end)

    def of_fields(self, chosen: list[int]) -> Path:
        """The same path with these fields only, in this order."""
        return Path(self.breaks, self.coefficients[:, chosen], self.end)

    def until(self, end: float) -> Path:
        """The same path with another end."""
        return Path(self.breaks, self.coefficients, end)

    def at(self, places: Array) -> Array:
        """All fields at places (n,), shape (fields, n)."""
        return _sums(self.coefficients.swapaxes(0, 1), *self._basis(places))

    def state(self, place: float) -> Array:
        """All fields at one place, shape (fields,)."""
        piece = self._piece(place)
        low, high = self.breaks[piece : piece + 2].tolist()
        x = min(max((2.0 * place - low - high) / (high - low), -1.0), 1.0)
        return np.asarray(self.coefficients[piece] @ np.cos(np.arange(self.coefficients.shape[2]) * math.acos(x)))

    def value(self, index: int, places: Array) -> Array:
        """One field at places of any shape."""
        return _sums(self.coefficients[:, index], *self._basis(places))

    def field(self, index: int, places: Array) -> tuple[Array, Array]:
        """One field and its derivative at places (n,)."""
        found = _sums(np.array([self.coefficients[:, index], self._rises[index]]), *self._basis(places))
        return found[0], found[1]

    def curve(self, index: int, piece: int) -> tuple[Curve, Curve]:
        """One field and its derivative as functions of a place in one piece."""
        low, high = self.breaks[piece : piece + 2].tolist()
        own = self.coefficients[piece, index]
        rise = slopes(own.size) @ own * (2.0 / (high - low))
        return chebyshev_curve(own.tolist(), low, high), chebyshev_curve(rise.tolist(), low, high)

    @cached_property
    def _rises(self) -> Array:
        """The coefficients of all derivatives, (fields, m, N+1)."""
        series = self.coefficients.swapaxes(0, 1) @ slopes(self.coefficients.shape[2]).T
        return np.asarray(series * (2.0 / np.diff(self.breaks))[:, None])

    @cached_property
    def places(self) -> Array:
        """Places that lie densely in every piece, shape (n,)."""
        edges = np.minimum(self.breaks[: self._last + 2], self.end)
        inside = edges[:-1, None] + DENSE[:-1] * (edges[1:] - edges[:-1])[:, None]
        return np.concatenate([inside.ravel(), edges[-1:]])

    @cached_property
    def _last(self) -> int:
        """The index of the piece in which it ends."""
        return int(self.breaks.searchsorted(self.end)) - 1

    def samples(self, index: int) -> Array:
        """One field at `places`, shape (n,)."""
        last = self._last
        low, high = self.breaks[last : last + 2].tolist()
        series = _at_dense(self.coefficients.shape[2])
        final = series
        if self.end < high:
            final = chebyshev((2.0 * DENSE * (self.end - low)) / (high - low) - 1.0, len(series))
        before = self.coefficients[:last, index] @ series[:, :-1]
        return np.concatenate([before.ravel(), self.coefficients[last, index] @ final])

    def highest(self, index: int, samples: Array) -> tuple[float, float]:
        """Place and height of the highest point of a field, whose :meth:`samples` are known."""
        i = int(np.argmax(samples))
        near, known = self.places[max(i - 1, 0) : i + 2].tolist(), -1
        # Each interval between samples lies in one piece, and the top in the one into which the curve rises.
        for low, high in pairwise(near):
            if (piece := int(self._piece(0.5 * (low + high)))) != known:
                known, (value, slope) = piece, self.curve(index, piece)
            ends = slope(low), slope(high)
            if ends[0] > 0.0 > ends[1]:
                top = falling_zero(slope, low, high, ends)
                return top, value(top)
        return float(self.places[i]), float(samples[i])

    def fall(self, index: int, level: float = 0.0) -> float | None:
        """Where a field first falls to a level in the last piece, after its start; None where it does not."""
        low, high = (float(place) for place in self.breaks[-2:])
        own = self.coefficients[-1, index]
        below = np.flatnonzero(own @ _at_close(own.size)[:, 1:] <= level)
        if not below.size:
            return None
        first, *others = own.tolist()
        before, after = (low + (high - low) * CLOSE[below[0] : below[0] + 2]).tolist()
        return falling_zero(chebyshev_curve([first - level, *others], low, high), before, after)

    def _piece(self, places: Array | float) -> NDArray[np.intp]:
        """The index of the piece of each place."""
        return np.asarray(self.breaks[1:-1].searchsorted(places, side="right"))

    def _basis(self, places: Array) -> tuple[Array, NDArray[np.intp] | None]:
        """Chebyshev polynomials at places of any shape, (N+1, ...), and the piece of each; None where there is one."""
        piece: NDArray[np.intp] | None = None
        low, high = self.breaks[:2]
        if len(self.coefficients) > 1:
            piece = self._piece(places)
            low, high = self.breaks[piece], self.breaks[piece + 1]
        x = (2.0 * places - low - high) / (high - low)
        return chebyshev(np.minimum(np.maximum(x, -1.0), 1.0), self.coefficients.shape[2]), piece


def _sums(series: Array, basis: Array, piece: NDArray[np.intp] | None) -> Array:
    """Polynomials (..., m, N+1), at each place the one of its piece, where the basis was made, (N+1, ...)."""
    flat, shape = basis.reshape(len(basis), -1), (*series.shape[:-2], *basis.shape[1:])
    if piece is None:
        return np.asarray((series[..., 0, :] @ flat).reshape(shape))
    if series.shape[-2] > FEW_PIECES:
        return np.asarray((series[..., piece.ravel(), :] * flat.T).sum(axis=-1).reshape(shape))
    # all of them at every place are sooner told than coefficients of every place
    return np.asarray((series @ flat)[..., piece.ravel(), np.arange(piece.size)].reshape(shape))


def values_of(index: int, paths: Sequence[Path], places: Array) -> Array:
    """One field of paths with as many coefficients, each at places of its own (B, n), and the same in any company."""
    piece = np.array([path._piece(own) for path, own in zip(paths, places, strict=True)])
    begun = np.cumsum([0, *(path.breaks.size for path in paths[:-1])])[:, None]  # of each path, among all breaks
    breaks = np.concatenate([path.breaks for path in paths])
    low, high = breaks[begun + piece], breaks[begun + piece + 1]
    x = np.minimum(np.maximum((2.0 * places - low - high) / (high - low), -1.0), 1.0)
    series = np.concatenate([path.coefficients[:, index] for path in paths])
    own = series[begun + piece - np.arange(len(paths))[:, None]]  # a path has a piece less than breaks
    return np.asarray((own * np.cos(np.arccos(x)[..., None] * np.arange(own.shape[-1]))).sum(axis=-1))


def chebyshev(x: Array, count: int) -> Array:
    """T_0 to T_{count-1}, two or more, at x: (count, ...). T_{m+k} = 2 T_m T_k - T_{m-k}; sooner told of many."""
    if x.size < FEW:
        return np.asarray(np.cos(np.multiply.outer(np.arange(count), np.arccos(x))))
    found = np.empty((count, *x.shape))
    found[0], found[1] = 1.0, x
    last = 1
    while last < count - 1:
        more = min(last, count - 1 - last)
        next_ones = np.multiply(2.0 * found[last], found[1 : more + 1], out=found[last + 1 : last + more + 1])
        next_ones -= found[last - more : last][::-1]
        last += more
    return found


@cache
def slopes(count: int) -> Array:
    """The matrix (n, n) from `count` coefficients to those of the derivative over (-1, 1)."""
    return np.pad(polynomial.chebder(np.eye(count), axis=0), ((0, 1), (0, 0)))


@cache
def _at_dense(count: int) -> Array:
    """The Chebyshev polynomials at DENSE, shape (count, shares)."""
    return chebyshev(2.0 * DENSE - 1.0, count)


@cache
def _at_close(count: int) -> Array:
    """The same at CLOSE."""
    return chebyshev(2.0 * CLOSE - 1.0, count)


def chebyshev_curve(series: list[float], low: float, high: float) -> Curve:
    """sum_n series_n T_n by Clenshaw's recurrence, as a function of a place from low, which is -1, to high, 1."""
    first, others, middle, scale = series[0], series[:0:-1], low + high, 1.0 / (high - low)

    def value(place: float) -> float:
        x = (2.0 * place - middle) * scale
        above, here, twice = 0.0, 0.0, 2.0 * x
        for coefficient in others:
            above, here = here, coefficient + twice * here - above
        return first + x * here - above

    return value


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
        i = np.searchsorted(table[1:-1], times)
        low, high = known[i], known[i + 1]
        place = np.interp(times, table, known)
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

    def samples(self, field: int) -> Array:
        """A field, 0 the depth and 3 the force, at `times`, shape (n,)."""
        return self.path.samples(self.depth + field)

    def highest(self, field: int, samples: Array) -> tuple[float, float]:
        """When a field of these samples is highest, and how high."""
        place, height = self.path.highest(self.depth + field, samples)
        return float(self.clock.time(np.array([place]))[0]), height
