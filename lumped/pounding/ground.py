"""Motions of the ground, each analytic between its kinks: what a Taylor series in time needs to know of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import factorial
from typing import Protocol

import numpy as np

from lumped.numbers import Array


class GroundMotion(Protocol):
    """A ground acceleration over time, m/s2, from t = 0 on."""

    @property
    def kinks(self) -> Array:
        """Times, s, ascending, between which it is analytic."""

    @property
    def fastest(self) -> float:
        """How fast it varies between kinks at most, rad/s."""

    def series(self, time: float, unit: float, terms: int) -> Array:
        """Its Taylor coefficients from `time`, s, on, over (t - time)/unit: shape (terms,)."""

    def acceleration(self, times: Array) -> Array:
        """It at `times`, m/s2, from the right at a jump."""


@dataclass(frozen=True, eq=False)
class GroundRecord:
    """Straight lines between recorded times, s, ascending from zero, and accelerations, m/s2, both (n,); then still."""

    times: Array
    values: Array

    @property
    def kinks(self) -> Array:
        """Every recorded time."""
        return self.times

    @property
    def fastest(self) -> float:
        """Straight lines do not vary."""
        return 0.0

    @cached_property
    def _slopes(self) -> Array:
        return np.diff(self.values) / np.diff(self.times)

    def series(self, time: float, unit: float, terms: int) -> Array:
        """Value and slope."""
        found = np.zeros(terms)
        i = int(np.searchsorted(self.times, time, side="right")) - 1
        if i < self._slopes.size:
            slope = self._slopes[i]
            found[:2] = self.values[i] + slope * (time - self.times[i]), slope * unit
        return found

    def acceleration(self, times: Array) -> Array:
        """Interpolated."""
        return np.interp(times, self.times, self.values, right=0.0)


@dataclass(frozen=True)
class Sine:
    """amplitude sin(2 pi frequency t) for so many cycles, then still: a harmonic, a full-cycle or a half-cycle pulse.

    `amplitude`: m/s2; `frequency`: Hz.
    """

    amplitude: float
    frequency: float
    cycles: float = np.inf

    @property
    def kinks(self) -> Array:
        """Its start and its end."""
        return np.array([0.0, self._end]) if np.isfinite(self.cycles) else np.zeros(1)

    @property
    def fastest(self) -> float:
        """2 pi frequency."""
        return float(2.0 * np.pi * self.frequency)

    @property
    def _end(self) -> float:
        return self.cycles / self.frequency

    def series(self, time: float, unit: float, terms: int) -> Array:
        """Derivatives of a sine over factorials."""
        if time >= self._end:
            return np.zeros(terms)
        step, phase = self.fastest * unit, self.fastest * time
        quarters = [np.sin(phase), np.cos(phase), -np.sin(phase), -np.cos(phase)]
        return self.amplitude * np.array([quarters[k % 4] * step**k / factorial(k) for k in range(terms)])

    def acceleration(self, times: Array) -> Array:
        """The sine."""
        return np.where(times < self._end, self.amplitude * np.sin(self.fastest * times), 0.0)


STILL = Sine(0.0, 1.0, 0.0)  # a ground at rest
