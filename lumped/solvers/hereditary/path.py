"""A solution in pieces, each a polynomial of every field of its state."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from lumped.solvers.hereditary.radau import Radau, slopes

Array = NDArray[np.float64]
Curve = Callable[[float], float]
# Shares of a piece that lie densely, and those between which a fall is sought.
DENSE, CLOSE = np.linspace(0.0, 1.0, 25), np.linspace(0.0, 1.0, 65)
# So many places are few.
FEW = 100
ROOT_STEPS = 100
ROUNDING = 4e-16


@dataclass(frozen=True, eq=False)
class Path:
    """`breaks` (m+1,) ascend; `coefficients` (m, fields, N+1) are those of Chebyshev polynomials in each piece.

    `end` is the last place, at most the last break: what lies beyond an event is no part of the path.
    """

    breaks: Array
    coefficients: Array
    end: float

    @classmethod
    def of(cls, breaks: Sequence[float], values: Sequence[Array], table: Radau) -> Path:
        """The path through `values`, for every piece (fields, N+1) at its first place and its nodes."""
        return cls(np.array(breaks), np.array(values) @ table.series.T, float(breaks[-1]))

    def joined(self, later: Path) -> Path:
        """The path, whole, and one that goes on from its last break."""
        breaks = np.append(self.breaks, later.breaks[1:])
        return Path(breaks, np.concatenate([self.coefficients, later.coefficients]), later.end)

    def of_fields(self, chosen: list[int]) -> Path:
        """The same path with these fields only, in this order."""
        return replace(self, coefficients=self.coefficients[:, chosen])

    def until(self, end: float) -> Path:
        """The same path with another end."""
        return replace(self, end=end)

    def at(self, places: Array) -> Array:
        """All fields at places (n,), shape (fields, n)."""
        basis, piece = self._basis(places)
        return np.asarray((self.coefficients[piece] @ basis.T[..., None])[..., 0].T)

    def state(self, place: float) -> Array:
        """All fields at one place, shape (fields,)."""
        piece = self._piece(place)
        low, high = self.breaks[piece : piece + 2].tolist()
        x = min(max((2.0 * place - low - high) / (high - low), -1.0), 1.0)
        return np.asarray(self.coefficients[piece] @ np.cos(np.arange(self.coefficients.shape[2]) * math.acos(x)))

    def value(self, index: int, places: Array) -> Array:
        """One field at places of any shape."""
        basis, piece = self._basis(places)
        return np.asarray((self.coefficients[:, index].T[:, piece] * basis).sum(axis=0))

    def field(self, index: int, places: Array) -> tuple[Array, Array]:
        """One field and its derivative at places (n,)."""
        basis, piece = self._basis(places)
        own = self.coefficients[:, index].T
        rise = slopes(len(own)) @ own * (2.0 / np.diff(self.breaks))
        return (own[:, piece] * basis).sum(axis=0), (rise[:, piece] * basis).sum(axis=0)

    def curve(self, index: int, near: float) -> tuple[Curve, Curve]:
        """One field and its derivative as functions of a place in the piece around `near`."""
        piece = self._piece(near)
        low, high = (float(place) for place in self.breaks[piece : piece + 2])
        own = self.coefficients[piece, index]
        rise = slopes(own.size) @ own * (2.0 / (high - low))

        def function(series: list[float]) -> Curve:
            return lambda place: chebyshev_sum(series, (2.0 * place - low - high) / (high - low))

        return function(own.tolist()), function(rise.tolist())

    @cached_property
    def places(self) -> Array:
        """Places that lie densely in every piece, shape (n,)."""
        inside = self.breaks[self.breaks < self.end]
        lengths = np.append(inside[1:], self.end) - inside
        return np.append((inside[:, None] + DENSE[:-1] * lengths[:, None]).ravel(), self.end)

    def samples(self, index: int) -> Array:
        """One field at `places`, shape (n,)."""
        last = int(np.searchsorted(self.breaks, self.end)) - 1
        low, high = self.breaks[last : last + 2].tolist()
        series = _at_dense(self.coefficients.shape[2])
        final = series
        if self.end < high:
            final = chebyshev((2.0 * DENSE * (self.end - low)) / (high - low) - 1.0, len(series))
        before = self.coefficients[:last, index] @ series[:, :-1]
        return np.append(before.ravel(), self.coefficients[last, index] @ final)

    def highest(self, index: int) -> tuple[float, float]:
        """Place and height of the highest point of a field."""
        values, places = self.samples(index), self.places.tolist()
        i = int(np.argmax(values))
        # Each interval between samples lies in one piece, and the top in the one into which the curve rises.
        for low, high in pairwise(places[max(i - 1, 0) : i + 2]):
            value, slope = self.curve(index, 0.5 * (low + high))
            if slope(low) > 0.0 > slope(high):
                top = falling_zero(slope, low, high)
                return top, value(top)
        return places[i], float(values[i])

    def fall(self, index: int, level: float = 0.0) -> float | None:
        """Where a field first falls to a level in the last piece, after its start; None where it does not."""
        low, high = (float(place) for place in self.breaks[-2:])
        own = self.coefficients[-1, index]
        below = np.flatnonzero(own @ _at_close(own.size)[:, 1:] <= level)
        if not below.size:
            return None
        value, _ = self.curve(index, 0.5 * (low + high))
        before, after = (low + (high - low) * CLOSE[below[0] : below[0] + 2]).tolist()
        return falling_zero(lambda place: value(place) - level, before, after)

    def _piece(self, places: Array | float) -> Array:
        """The index of the piece of each place."""
        return np.minimum(np.searchsorted(self.breaks[1:-1], places, side="right"), len(self.coefficients) - 1)

    def _basis(self, places: Array) -> tuple[Array, Array]:
        """Chebyshev polynomials at places of any shape, (N+1, ...), and the piece of each."""
        piece = self._piece(places)
        low, high = self.breaks[piece], self.breaks[piece + 1]
        x = (2.0 * places - low - high) / (high - low)
        return chebyshev(np.minimum(np.maximum(x, -1.0), 1.0), self.coefficients.shape[2]), piece


def chebyshev(x: Array, count: int) -> Array:
    """T_0 to T_{count-1}, two or more, at x: (count, ...). T_{m+k} = 2 T_m T_k - T_{m-k}; sooner told of many."""
    if x.size < FEW:
        return np.asarray(np.cos(np.multiply.outer(np.arange(count), np.arccos(x))))
    found = np.empty((count, *x.shape))
    found[0], found[1] = 1.0, x
    last = 1
    while last < count - 1:
        more = min(last, count - 1 - last)
        found[last + 1 : last + more + 1] = 2.0 * found[last] * found[1 : more + 1] - found[last - more : last][::-1]
        last += more
    return found


@cache
def _at_dense(count: int) -> Array:
    """The Chebyshev polynomials at DENSE, shape (count, shares)."""
    return chebyshev(2.0 * DENSE - 1.0, count)


@cache
def _at_close(count: int) -> Array:
    """The same at CLOSE."""
    return chebyshev(2.0 * CLOSE - 1.0, count)


def chebyshev_sum(series: list[float], x: float) -> float:
    """sum_n series_n T_n(x) by Clenshaw's recurrence."""
    above, value, twice = 0.0, 0.0, 2.0 * x
    for coefficient in series[:0:-1]:
        above, value = value, coefficient + twice * value - above
    return series[0] + x * value - above


def falling_zero(value: Curve, low: float, high: float) -> float:
    """Where `value` falls to zero between `low`, where it is positive, and `high`: false position, Illinois."""
    at_low, at_high, side, place = value(low), value(high), 0, high
    if at_low <= 0.0:
        return low
    for _ in range(ROOT_STEPS):
        before, place = place, high - at_high * (high - low) / (at_high - at_low)
        found = value(place)
        if found == 0.0 or abs(place - before) <= ROUNDING * abs(high):
            break
        if found > 0.0:
            low, at_low, at_high, side = place, found, at_high * (0.5 if side == 1 else 1.0), 1
        else:
            high, at_high, at_low, side = place, found, at_low * (0.5 if side == -1 else 1.0), -1
    return place
