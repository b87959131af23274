"""Numbers that know no physics: local polynomials, peaks between rows, integrals, Gauss' points, zeros, clocks."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache
from time import perf_counter, process_time
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Real = Any  # a float of floats, an array of arrays, of their shape: what numpy's functions return has no better type
POINTS = 4  # rows around a place through which a polynomial is laid
FITTED, DEGREE = 13, 4  # places around a peak, and the degree of the polynomial fitted to them
JUMP = 10.0  # safety: over the slopes beside it, that of an interval in which no rows tell a smooth curve
EQUAL = 1e-12  # of all the rows: two as close as that are one, and no slope lies between them but rounding's
# Steps of false position and of bisection, more than either takes; two places as near, relatively, are one.
ROOT_STEPS, BISECTIONS, ROUNDING = 100, 200, 4e-16
# Rounding: of a time that is a sum of hundreds of steps, and of a flight after a rate with as many, relative to it.
ROUNDED_TIME = 3e-14


def local(x: Array, y: Array, at: Array, points: int = POINTS) -> Array:
    """The polynomials through the `points` nodes around each place of `at`, shape (m,): shape (..., m).

    `x`, shape (n,), ascends strictly; `y` has the shape (..., n). With fewer nodes than `points` all of them
    count.
    """
    points = min(points, x.size)
    first = np.searchsorted(x, at) - (points + 1) // 2
    stencil = np.clip(first, 0, x.size - points) + np.arange(points)[:, None]
    nodes = x[stencil]
    away, weights = at - nodes, np.ones_like(nodes)
    for j in range(points):
        for i in range(points):
            if i != j:
                weights[j] *= away[i] / (nodes[j] - nodes[i])
    return np.asarray((weights * y[..., stencil]).sum(axis=-2))


def peak(x: Array, y: Array) -> tuple[float, float]:
    """Place and height of the highest point of a curve given by rows, x ascending; of equal x the highest.

    Between rows by their polynomial, where a curve that goes on through them may have a peak like that. Else the
    highest row: beside a jump, and where rows crowd so that a polynomial tells their rounding.
    """
    new = np.flatnonzero(np.diff(x, prepend=-np.inf) > EQUAL * (x[-1] - x[0]))
    rows, values = x[new], np.maximum.reduceat(y, new)
    top = int(np.argmax(values))
    least, most = _peaks_beside(rows, values, top)
    if least < most:
        place, height = highest(lambda at: local(rows, values, at), rows)
        if least <= height <= most:
            return place, height
    return float(rows[top]), float(values[top])


def _peaks_beside(x: Array, y: Array, top: int) -> tuple[float, float]:
    """The lowest and the highest peak of a curve that goes on through these rows, the highest of them the one at `top`.

    Where such a curve is bent downwards it stays below the secants of the next intervals, prolonged over this one. An
    interval far steeper than those beside it is a jump: the row itself is the peak.
    """
    steps = np.diff(x)
    slopes = np.diff(y) / steps
    before, after = np.append(np.inf, slopes), np.append(slopes, -np.inf)  # nothing is known beyond the ends
    least = most = float(y[top])
    for k in range(max(top - 1, 0), min(top + 1, steps.size)):
        beside = np.abs(slopes[[j for j in (k - 1, k + 1) if 0 <= j < steps.size]])
        if beside.size and np.abs(slopes[k]) > JUMP * beside.max():
            return least, least
        ends = y[k] + max(before[k], 0.0) * steps[k], y[k + 1] - min(after[k + 1], 0.0) * steps[k]
        least, most = min(least, float(y[k] if k < top else y[k + 1])), max(most, float(min(ends)))
    return least, most


def highest(curve: Callable[[Array], Array], places: Array) -> tuple[float, float]:
    """Place and height of the highest point of a curve that can be evaluated anywhere, shape (n,) -> (n,).

    The polynomial of fourth degree fitted around the highest of `places` (ascending, at least two) has it:
    what noise the curve has there averages out.
    """
    values = curve(places)
    i = int(np.argmax(values))
    low, high = places[max(i - 1, 0)], places[min(i + 1, places.size - 1)]
    around = np.linspace(-1.0, 1.0, FITTED)
    between = np.clip(0.5 * (low + high) + 0.5 * (high - low) * around, low, high)  # the curve may jump where it begins
    fit = np.polynomial.Polynomial.fit(around, curve(between), DEGREE)
    flat = fit.deriv().roots()
    inside = np.real(flat[(np.abs(np.imag(flat)) < 1e-12) & (np.abs(np.real(flat)) < 1.0)])
    candidates = np.concatenate([inside, [-1.0, 1.0]])
    heights = fit(candidates)
    best = int(np.argmax(heights))
    return float(0.5 * (low + high) + 0.5 * (high - low) * candidates[best]), float(heights[best])


def rounded_by_time(times: Array, force: Array, rounded: Array | None = None) -> Array:
    """What rounding of times, ascending, (n,), shifts a force by between them, N, (n - 1,): a steep one late by much.

    ``rounded`` (n - 1,), s: by how much, where it is more than that of a time.

    By no more than the force changes between two rows that rounding cannot tell apart.
    """
    rounded = ROUNDED_TIME * times[1:] if rounded is None else rounded
    steps = np.maximum(np.diff(times), rounded)
    share = np.divide(rounded, steps, out=np.zeros_like(steps), where=steps > 0.0)
    return np.asarray(np.abs(np.diff(force)) * share)


def running_integral(values: Array, places: Array) -> Array:
    """Integral of values (n,) from the first of the places (n,) to each of them, by the trapezoidal rule."""
    return np.append(0.0, np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(places)))


@cache
def gauss(points: int) -> tuple[Array, Array]:
    """Nodes and weights on (0, 1), each of shape (points,)."""
    nodes, weights = np.polynomial.legendre.leggauss(points)
    return 0.5 * (nodes + 1.0), 0.5 * weights


def falling_zero(
    value: Callable[[float], float],
    low: float,
    high: float,
    ends: tuple[float, float] | None = None,
    close: float = ROUNDING,
    small: float = 0.0,
) -> float:
    """Where `value` falls to zero between `low`, where it is positive, and `high`, where it is not: false position,
    Illinois.

    `ends`: its values there, where they are known. Found are two places in a row as `close`, relatively, or a value as
    `small`.
    """
    at_low, at_high = ends or (value(low), value(high))
    if at_low <= 0.0:
        return low
    if at_high > 0.0:  # but for rounding it is not: who saw the fall summed otherwise
        return high
    place, side = high, 0
    for _ in range(ROOT_STEPS):
        before, place = place, high - at_high * (high - low) / (at_high - at_low)
        if abs(place - before) <= close * abs(high):
            break
        found = value(place)
        if abs(found) <= small:
            break
        if found > 0.0:
            low, at_low, at_high, side = place, found, at_high * (0.5 if side == 1 else 1.0), 1
        else:
            high, at_high, at_low, side = place, found, at_low * (0.5 if side == -1 else 1.0), -1
    return place


def bisected(before: Callable[[float], bool], low: float, high: float) -> tuple[float, float]:
    """Between `low`, where `before` is true, and `high`, to the last digit: where it is still, and where no longer."""
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (middle, high) if before(middle) else (low, middle)
    return low, high


def freeze_columns(record: object, names: Iterable[str]) -> dict[str, Array]:
    """The columns of a frozen record by these names, made arrays of its own that nobody can write into."""
    found = {name: np.array(getattr(record, name), dtype=float) for name in names}
    for name, column in found.items():
        column.flags.writeable = False
        object.__setattr__(record, name, column)
    return found


class Clock:
    """Wall and process time since it was made."""

    def __init__(self) -> None:
        self.wall, self.cpu = perf_counter(), process_time()

    def read(self) -> dict[str, float]:
        """Seconds, as `timing` of a result has them."""
        return {"wall_s": perf_counter() - self.wall, "cpu_s": process_time() - self.cpu}
