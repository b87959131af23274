"""Functions of the two stretches in the plane, smooth where they are equal.

With l1 = sqrt(j) e^b, l2 = sqrt(j) e^-b and q = D/(2 j) = cosh(2 b) - 1, both b^2 and cosh(n b) are analytic in q: they
solve q (q + 2) f'' + (1 + q) f' = s(f), which gives their series, and f'' from f'.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.polynomial import polynomial

from lumped.materials.energies.base import Invariants, Jet
from lumped.numbers import Array

SMALL = 0.1  # rounding: q below which the series is summed, whose terms fall as (q/2)^n
TERMS = 14  # rounding: as many terms reach 1e-16 there


def log_difference_squared(invariants: Invariants) -> Jet:
    """b^2, b = (ln l1 - ln l2)/2."""
    powers = np.arange(1, TERMS)
    ratios = -(powers**2) / ((powers + 1.0) * (2.0 * powers + 1.0))
    series = np.concatenate([[0.0, 0.5], 0.5 * np.cumprod(ratios)])

    def closed(b: Array) -> tuple[Array, Array, Array]:
        return b**2, 2.0 * b, np.full_like(b, 0.5)

    return _function(invariants, series, closed)


def hyperbolic_cosine(invariants: Invariants, power: float) -> Jet:
    """cosh(n b) = (l1^n + l2^n)/(2 j^(n/2))."""
    powers = np.arange(TERMS)
    series = np.cumprod(np.append(1.0, (0.25 * power**2 - powers**2) / ((powers + 1.0) * (2.0 * powers + 1.0))))

    def closed(b: Array) -> tuple[Array, Array, Array]:
        value = np.cosh(power * b)
        return value, power * np.sinh(power * b), 0.25 * power**2 * value

    return _function(invariants, series, closed)


def _function(invariants: Invariants, series: Array, closed: Callable[[Array], tuple[Array, Array, Array]]) -> Jet:
    """Of q, by its coefficients, and by its value, derivative in b and s(f) at b."""
    ratio = invariants.shape * (0.5 * invariants.area**-1.0)
    small = ratio.value < SMALL
    near = np.where(small, ratio.value, 0.0)
    found = [polynomial.polyval(near, polynomial.polyder(series, order)) for order in range(3)]
    q = np.where(small, 1.0, ratio.value)
    sine = np.sqrt(q * (q + 2.0))
    value, slope, source = closed(0.5 * np.arcsinh(sine))
    first = slope / (2.0 * sine)
    second = (source - (1.0 + q) * first) / (q * (q + 2.0))
    return ratio.of(*(np.where(small, low, high) for low, high in zip(found, (value, first, second), strict=True)))
