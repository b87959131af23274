"""What is measured of a Prony series: its decay over time, or its answer to oscillations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
# exp(-x) is zero beyond.
FADED = 745.0


@dataclass(frozen=True, eq=False)
class Decay:
    """E(t) at `times`, s, shape (m,), of which the first may be 0 and the last infinite."""

    times: Array

    @property
    def steady(self) -> Array:
        return np.ones((self.times.size, 1))

    def of(self, taus: Array) -> Array:
        return np.exp(-self._ages(taus))

    def slope(self, taus: Array) -> Array:
        ages = self._ages(taus)
        return np.asarray(ages * np.exp(-ages))

    def _ages(self, taus: Array) -> Array:
        with np.errstate(over="ignore"):
            return np.minimum(self.times[:, None] / taus, FADED)


@dataclass(frozen=True, eq=False)
class Oscillation:
    """Storage modulus and, below it, loss modulus at angular frequencies `omega`, 1/s, (m,): 2m rows."""

    omega: Array
    viscous: bool = False

    @property
    def steady(self) -> Array:
        still, ones = np.zeros_like(self.omega), np.ones_like(self.omega)
        columns = [np.concatenate([ones, still])]
        if self.viscous:
            columns.append(np.concatenate([still, self.omega]))
        return np.column_stack(columns)

    def of(self, taus: Array) -> Array:
        turn = 1j * self.omega[:, None] * taus
        return stacked(turn / (1.0 + turn))

    def slope(self, taus: Array) -> Array:
        turn = 1j * self.omega[:, None] * taus
        return stacked(turn / (1.0 + turn) ** 2)


def stacked(modulus: NDArray[np.complex128]) -> Array:
    """Real parts above imaginary parts, (2m, ...) from (m, ...)."""
    return np.concatenate([modulus.real, modulus.imag])
