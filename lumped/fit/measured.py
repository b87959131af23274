"""What a fit compares with: the points of a curve, and the silence after its end."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lumped.errors import BadInput, Fault
from lumped.numbers import Array, peak
from lumped.result.gate import MeasuredPulse
from lumped.result.history import History
from lumped.result.noise import whiteness
from lumped.result.score import POINTS, Curve

# A curve whose last force is at most this share of its peak has ended: after it the force is zero.
ENDED = 0.05
# How far beyond its end a longer contact is told from it, as a share of its length.
BEYOND = 0.5
# A law that a scene has to follow is smooth between as many points; more would cost time and tell nothing.
MOST_POINTS = 2000
# Of the peak: what is left of a computed history is no noise, and below this no error of a law either.
EXACT = 1e-5


@dataclass(frozen=True, eq=False)
class Measured:
    """Times, s, and forces, N: `points` of the curve's own, then the silence; `peak`, N.

    `weight`: roots of the times that the points stand for, one where they are equally spaced: rows that crowd count
    no more than others. `together`: how many neighbouring rows of the curve each point is the mean of.
    """

    time: Array
    force: Array
    weight: Array
    points: int
    peak: float
    together: int = 1

    @classmethod
    def of(cls, curve: History | Curve) -> Measured:
        """The own rows of a measured curve, of many the means, or 201 rows of a computed history. Raises BadInput."""
        rows = _spread(curve.time) if isinstance(curve, History) else slice(None)
        together = 1 if isinstance(curve, History) else -(-curve.time.size // MOST_POINTS)
        time, force = means(curve.time[rows], together), means(curve.force[rows], together)
        highest = peak(curve.time, curve.force)[1] if isinstance(curve, History) else float(force.max())
        if not highest > 0.0 or not time[-1] > max(time[0], 0.0):
            raise BadInput(Fault("curve", "", "has no force above zero after t = 0; accepted: a contact"))
        after = _silence(time) if force[-1] <= ENDED * highest else time[:0]
        spacing = _spacing(time)
        weight = np.append(np.sqrt(spacing / spacing.mean()), np.ones(after.size))
        return cls(np.append(time, after), np.append(force, 0.0 * after), weight, time.size, highest, together)

    @property
    def ended(self) -> bool:
        """Whether the force has returned to zero: else the curve is cut off, and says nothing of what follows."""
        return self.time.size > self.points

    @property
    def duration(self) -> float:
        """About how long the force lasts, s; of a curve cut off before its end, twice the time to its peak."""
        own, force = self.time[: self.points], self.force[: self.points]
        if not self.ended:
            return float(2.0 * own[int(np.argmax(force))]) or float(own[-1])
        return self._pulse.width

    @property
    def begin(self) -> float:
        """About when the bodies touch, s."""
        return self._pulse.start if self.ended else 0.0

    @cached_property
    def _pulse(self) -> MeasuredPulse:
        own = slice(0, self.points)
        return MeasuredPulse(self.time[own], self.force[own])

    @property
    def impulse(self) -> float:
        """int F dt over the curve, N s."""
        return float(np.trapezoid(self.force, self.time))

    def error_of(self, force: Array) -> Array:
        """The weighted residual of a force at the times, shape (n,), relative to the peak."""
        return np.asarray(self.weight * (force - self.force) / self.peak)

    def normalized_error(self, force: Array) -> float:
        """The error "(20)", "(21)" of a force at the times, shape (n,): norm of what differs over that of the curve."""
        return float(np.linalg.norm(self.error_of(force)) / np.linalg.norm(self.weight * self.force / self.peak))

    def systematic(self, error: Array) -> bool:
        """Whether residuals show what a law cannot follow, and not noise alone."""
        own = error[: self.points]
        return float(own @ own) > EXACT**2 * own.size and whiteness([own]).of_the_law


def _spread(time: Array) -> NDArray[np.intp]:
    """Rows nearest to equally spaced times: between the rows even a computed history is only interpolated."""
    return np.unique(np.searchsorted(time, np.linspace(time[0], time[-1], POINTS)))


def means(column: Array, together: int) -> Array:
    """The means of so many neighbouring rows each: they are known as well as the rows are."""
    starts = np.arange(0, column.size, together)
    return np.asarray(np.add.reduceat(column, starts) / np.diff(np.append(starts, column.size)))


def _spacing(time: Array) -> Array:
    """The time that each row stands for, s: half of the way to both neighbours, at the ends all of it to the one."""
    steps = np.diff(time)
    return np.asarray(0.5 * (np.append(steps[0], steps) + np.append(steps, steps[-1])))


def _silence(time: Array) -> Array:
    """Times after the end, as dense as those before it."""
    step = (time[-1] - time[0]) / (time.size - 1)
    return np.asarray(time[-1] + step * np.arange(1, int(BEYOND * time.size) + 2))
