"""Polynomials through the nearest nodes of a curve, several fields at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array

STENCIL = 6  # nodes of a polynomial
PLACES = 17  # equidistant, from which a quartic is fitted
FINE = np.linspace(0.0, 1.0, 201)  # where in an interval a maximum is looked for
BETWEEN = np.linspace(-1.0, 1.0, PLACES)  # places on (-1, 1) through which a quartic is fitted
NEAREST_QUARTIC = np.linalg.pinv(np.vander(BETWEEN, 5))  # from values there to its five coefficients


@dataclass(frozen=True, eq=False)
class LocalPolynomials:
    """Newton's form through every six successive ``nodes`` (n,), which increase, or through all if they are fewer.

    ``differences`` (level, field, polynomial): divided differences on the first nodes of each polynomial.
    """

    nodes: Array
    differences: Array

    @classmethod
    def through(cls, nodes: Array, values: Array) -> LocalPolynomials:
        """Polynomials of the fields ``values`` (f, n)."""
        size = min(STENCIL, len(nodes))
        table = [values]
        for level in range(1, size):
            table.append((table[-1][:, 1:] - table[-1][:, :-1]) / (nodes[level:] - nodes[:-level]))
        return cls(nodes, np.stack([level[:, : len(nodes) - size + 1] for level in table]))

    def at(self, places: Array) -> tuple[Array, Array]:
        """Value and derivative of every field, (f, p), each by the polynomial whose nodes lie around."""
        size, fields, count = self.differences.shape
        first = np.minimum(np.maximum(self.nodes.searchsorted(places) - size // 2, 0), count - 1)
        coefficients = self.differences.take(first, axis=2)
        steps = places - self.nodes.take(first + np.arange(size - 1)[:, None])
        value, slope = coefficients[-1], np.zeros((fields, len(places)))
        for step, coefficient in zip(steps[::-1], coefficients[-2::-1], strict=True):
            slope *= step
            slope += value
            value *= step
            value += coefficient
        return value, slope


def peak(time: Array, values: Array) -> tuple[float, float]:
    """Place and height of the maximum, by the quartic through the highest sample's neighbourhood."""
    top = min(max(int(np.argmax(values)), 2), len(values) - 3)
    around = slice(top - 2, top + 3)
    span = time[top + 2] - time[top - 2]
    x = np.asarray((time[around] - time[top]) / span, dtype=np.float64)
    quartic = np.asarray(np.linalg.solve(np.vander(x), values[around]), dtype=np.float64)
    best, height = _top(quartic, float(x[0]), float(x[-1]))
    return float(time[top] + best * span), height


def fitted_peak(first: float, last: float, values: Array) -> tuple[float, float]:
    """Place between ``first`` and ``last`` and height of the maximum, by the quartic nearest to ``PLACES`` values.

    Their neighbours' mean keeps a small jitter of the values from moving the place.
    """
    best, height = _top(NEAREST_QUARTIC @ values, -1.0, 1.0)
    return first + 0.5 * (best + 1.0) * (last - first), height


def _top(quartic: Array, low: float, high: float) -> tuple[float, float]:
    """Place and height of a quartic's maximum in an interval."""
    a, b, c, d, e = quartic.tolist()
    fine = low + (high - low) * FINE
    best = float(fine[int(np.argmax((((a * fine + b) * fine + c) * fine + d) * fine))])
    spacing = (high - low) * float(FINE[1])
    best = _stationary(quartic, best, max(best - spacing, low), min(best + spacing, high))
    return best, (((a * best + b) * best + c) * best + d) * best + e


def _stationary(quartic: Array, place: float, low: float, high: float) -> float:
    """Where the quartic's derivative vanishes between ``low`` and ``high``, by Newton's method; else near its end."""
    a, b, c, d, _ = quartic.tolist()
    for _ in range(4):
        slope = ((4 * a * place + 3 * b) * place + 2 * c) * place + d
        bend = (12 * a * place + 6 * b) * place + 2 * c
        if bend >= 0.0:
            return place
        place = min(max(place - slope / bend, low), high)
    return place
