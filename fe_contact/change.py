"""What one varied setting changes, quantity by quantity, and the error that this change stands for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from fe_contact.curve import Curve
from fe_contact.forms import Array

PEAK_SHARE = 0.98  # the force's own error is the largest one while the force exceeds this share of its peak
SMOOTHING = 0.04  # share of the contact over which a pointwise change counts as the error of its neighbours
LATE = 0.75  # share of the contact after which path and speed count for those at separation


@dataclass(frozen=True)
class Change:
    """Two curves that differ in one setting, and the factor that turns their difference into an error."""

    first: Curve
    second: Curve
    factor: float

    def of(self, name: str) -> float:
        """Error of a quantity, in its unit.

        What is read at one instant takes the largest change around it: a difference of two curves may cross
        zero just there, which makes neither of them right.
        """
        first, second = self.first.quantities[name], self.second.quantities[name]
        if first is None or second is None:
            return np.inf if first is not second else 0.0
        around = {
            "peak_force": self.factor * self._peak_force,
            "peak_time": self.factor * self._peak_time,
            "peak_depth": self.factor * self._depth_change[self._near_depth].max(),
            "duration": self.factor * self._depth_change[self._late].max() / abs(self.first.leaving_speed),
            "impulse": self.factor * self._impulse,
            "restitution": self.factor * self.velocity / self.first.strike.velocity,
        }
        return max(self.factor * abs(first - second), float(around[name]))

    def history(self) -> float:
        """Norm of the force's change over the norm of the force."""
        time = self.first.dense_time
        change = np.trapezoid(self._force_change**2, time)
        return self.factor * float(np.sqrt(change / np.trapezoid(self.first.dense_force**2, time)))

    def force(self, time: Array) -> Array:
        """Error of the force at times, N: the largest change in the neighbourhood of each."""
        width = max(1, round(SMOOTHING * len(self._force_change)))
        padded = np.pad(self._force_change, width, mode="edge")
        around = np.lib.stride_tricks.sliding_window_view(padded, 2 * width + 1).max(axis=1)
        return np.asarray(self.factor * np.interp(time, self.first.dense_time, around))

    @cached_property
    def _force_change(self) -> Array:
        return np.abs(self.first.dense_force - self.second.force(self.first.dense_time))

    @cached_property
    def _depth_change(self) -> Array:
        return np.abs(self.first.dense_depth - self.second.depth_at(self.first.dense_time))

    @cached_property
    def _near_depth(self) -> npt.NDArray[np.bool_]:
        depth = self.first.dense_depth
        return np.asarray(depth > PEAK_SHARE * depth.max())

    @cached_property
    def velocity(self) -> float:
        """Largest change of the velocity late in the contact, m/s."""
        return self._late_change(Curve.velocity_at)

    @cached_property
    def _impulse(self) -> float:
        return self._late_change(Curve.impulse_at)

    def _late_change(self, read: Callable[[Curve, Array], Array]) -> float:
        """Largest change of what is read late in the contact, compared at equal shares of it."""
        time = self.first.dense_time
        shared = time * (self.second.duration / self.first.duration)
        change = read(self.first, time) - read(self.second, shared)
        return float(np.abs(change[self._late]).max())

    @cached_property
    def _late(self) -> npt.NDArray[np.bool_]:
        return np.asarray(self.first.dense_time >= LATE * self.first.duration)

    @cached_property
    def _peak_force(self) -> float:
        return float(self._force_change[self._near_peak].max())

    @cached_property
    def _peak_time(self) -> float:
        """How far a change of the force's slope moves its peak: slope over curvature, s."""
        time, force, near = self.first.dense_time, self.first.dense_force, self._near_peak
        top = min(max(int(force.argmax()), 1), len(force) - 2)
        left = min(int(np.flatnonzero(near)[0]), top - 1)
        right = max(int(np.flatnonzero(near)[-1]), top + 1)
        slope = np.abs(np.gradient(self.second.force(time) - force, time)[left : right + 1]).max()
        falling = (force[top] - force[right]) / (time[right] - time[top])
        rising = (force[top] - force[left]) / (time[top] - time[left])
        curvature = 2 * (falling + rising) / (time[right] - time[left])
        return float(min(slope / abs(curvature), self.first.duration)) if curvature else self.first.duration

    @cached_property
    def _near_peak(self) -> npt.NDArray[np.bool_]:
        force = self.first.dense_force
        return np.asarray(force > PEAK_SHARE * force.max())
