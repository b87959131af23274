"""An elastic bar that bounces on a rigid plane: its one-dimensional waves, exactly, contact after contact.

In the frame that falls with the free bar the velocity is a(t - x/c) + a(t + x/c - T), T = 2 L/c, which leaves the far
end free of stress. With impedance Z = density c A and the speed of free fall V(t) = v0 + g t the near end obeys

    contact: V = a(t) + a(t - T) ,    F = Z [V - 2 a(t - T)] >= 0 ;
    flight:  a(t) = a(t - T) ,        d gap/dt = 2 a(t - T) - V ,

so that the wave is piecewise linear in time, the gap piecewise quadratic, and every touch and separation a root in
closed form. The bouncing bar and the bar's impact of Doyen, Ern and Piperno 2011, doi:10.1137/100791440, are two of
its cases.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import NotReached
from lumped.numbers import Array
from lumped.progress import step_done

MOST_PIECES = 100_000  # work: waves in the bar until the time asked for
ROUNDING = 1e-12  # of the transit time and of the largest speed


@dataclass(frozen=True)
class StraightBar:
    """Length, m, wave speed c, m/s, impedance density c A, N s/m; no mass but its own."""

    length: float
    speed: float
    impedance: float

    @property
    def echo(self) -> float:
        """T = 2 L/c, s: when the far end answers."""
        return 2.0 * self.length / self.speed

    @property
    def mass(self) -> float:
        """density A L, kg."""
        return 0.5 * self.impedance * self.echo


class BarPiece(NamedTuple):
    """From ``start``, s, on: the wave ``value`` + ``slope`` (t - start), m/s, the gap and whether it is closed."""

    start: float
    value: float
    slope: float
    gap: float
    closed: bool


@dataclass(frozen=True)
class Bounces:
    """The motion from t = 0 to ``end``, s, piece by piece; speed ``velocity`` and gap at its start, m/s, m."""

    bar: StraightBar
    velocity: float
    gravity: float
    end: float
    pieces: tuple[BarPiece, ...]

    def fall(self, time: ArrayLike) -> Array:
        """V(t), m/s."""
        return self.velocity + self.gravity * np.asarray(time, dtype=float)

    @cached_property
    def columns(self) -> tuple[Array, Array, Array]:
        """Start, value and slope of every piece, each (n,)."""
        starts, values, slopes, *_ = zip(*self.pieces, strict=True)
        return np.array(starts), np.array(values), np.array(slopes)

    def wave(self, time: ArrayLike) -> Array:
        """a(t), m/s; zero before the start."""
        t = np.asarray(time, dtype=float)
        starts, values, slopes = self.columns
        index = np.maximum(np.searchsorted(starts, t, side="right") - 1, 0)
        return np.where(t < 0.0, 0.0, values[index] + slopes[index] * (t - starts[index]))

    def force(self, time: ArrayLike) -> Array:
        """Contact force, N; at a jump what follows it."""
        t = np.asarray(time, dtype=float)
        closed = np.array([piece.closed for piece in self.pieces])
        index = np.maximum(np.searchsorted(self.columns[0], t, side="right") - 1, 0)
        pressed = self.bar.impedance * (self.fall(t) - 2.0 * self.wave(t - self.bar.echo))
        return np.where(closed[index] & (t >= 0.0), pressed, 0.0)

    @property
    def contacts(self) -> tuple[tuple[float, float], ...]:
        """Touch and separation of every contact, s; the last may end with the motion."""
        found, start = list[tuple[float, float]](), None
        for piece in self.pieces:
            if piece.closed and start is None:
                start = piece.start
            elif not piece.closed and start is not None:
                found.append((start, piece.start))
                start = None
        return tuple(found if start is None else [*found, (start, self.end)])

    def momentum(self, time: float) -> float:
        """Of the whole bar away from the plane, N s: Z times the integral of the wave over one echo, less M V."""
        return self.bar.impedance * self._integral(time, 1) - self.bar.mass * float(self.fall(time))

    def energy(self, time: float) -> float:
        """Kinetic and strain energy, J."""
        fall = float(self.fall(time))
        waves = self.bar.impedance * (self._integral(time, 2) - fall * self._integral(time, 1))
        return waves + 0.5 * self.bar.mass * fall**2

    def _integral(self, time: float, power: int) -> float:
        """Of a^power over the echo before a time; a piece is linear, which two points a piece integrate."""
        knots = [piece.start for piece in self.pieces if time - self.bar.echo < piece.start < time]
        edges = np.array([max(time - self.bar.echo, 0.0), *knots, max(time, 0.0)])
        middle, half = 0.5 * (edges[1:] + edges[:-1]), 0.5 * np.diff(edges)
        return float(sum(half @ self.wave(middle + half * x) ** power for x in (-(3**-0.5), 3**-0.5)))


def bounces(
    bar: StraightBar, velocity: float, gravity: float, gap: float, end: float, contacts: float = math.inf
) -> Bounces:
    """Follow an unstrained bar that falls towards the plane, ``gap`` m away, until ``end``, s, or so many contacts.

    Raises NotReached where contacts grow too many to be followed.
    """
    pieces = list[BarPiece]()
    time, closed, parted = 0.0, False, 0
    while time < end and parted < contacts:
        if len(pieces) > MOST_PIECES:
            raise NotReached(f"bar: more than {MOST_PIECES} waves before t = {time:.6g} s", "an earlier end")
        step_done()
        value, slope, until = _echo(pieces, time - bar.echo, time)
        until += bar.echo
        pressing, rate = velocity + gravity * time - 2.0 * value, gravity - 2.0 * slope  # F/Z and its slope
        touched = closed
        gap, closed = _decided(gap, closed, pressing, rate, velocity + abs(gravity) * bar.echo, bar.echo)
        parted += touched and not closed
        if closed:
            pieces.append(BarPiece(time, velocity + gravity * time - value, gravity - slope, 0.0, True))
            until = min(until, time + _falls(pressing, rate))
        else:
            pieces.append(BarPiece(time, value, slope, gap, False))
            until = min(until, time + _closes(gap, pressing, rate))
            gap += -pressing * (until - time) - 0.5 * rate * (until - time) ** 2
        time = until
    return Bounces(bar, velocity, gravity, min(time, end), tuple(pieces))


def _echo(pieces: list[BarPiece], time: float, known: float) -> tuple[float, float, float]:
    """Value and slope of the wave from a time on, and until when; zero before the start, ``known`` up to a time."""
    later = bisect_right(pieces, time + ROUNDING * known, key=lambda piece: piece.start)
    if time < -ROUNDING * known or not later:
        return 0.0, 0.0, 0.0
    piece = pieces[later - 1]
    until = pieces[later].start if later < len(pieces) else known
    return piece.value + piece.slope * (time - piece.start), piece.slope, until


def _decided(gap: float, closed: bool, pressing: float, rate: float, speed: float, echo: float) -> tuple[float, bool]:
    """The gap without its rounding, and whether it is closed from now on; ``speed`` and ``echo`` say what is small."""
    small = ROUNDING * speed
    if closed or gap <= small * echo:
        return 0.0, pressing > small or (abs(pressing) <= small and rate > 0.0)
    return gap, False


def _falls(pressing: float, rate: float) -> float:
    """When a force that changes linearly is zero, s from now."""
    return -pressing / rate if rate < 0.0 else math.inf


def _closes(gap: float, pressing: float, rate: float) -> float:
    """The first s > 0 at which gap - pressing s - rate s^2/2 = 0; none where the gap is still open when it turns."""
    square = pressing**2 + 2.0 * rate * gap
    if square < 0.0:
        return math.inf
    added = pressing + math.copysign(math.sqrt(square), pressing)  # without a difference of like numbers
    roots = [-added / rate] if rate else []
    roots += [2.0 * gap / added] if added else []
    least = ROUNDING * abs(pressing / rate) if rate else 0.0
    return min((root for root in roots if root > least), default=math.inf)
