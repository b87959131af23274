"""How deep a row of Table 1 holds: where forces by finite elements leave its power law."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array
from lumped.indentation import Indentation
from lumped.paper.table1 import Elastic, TableRow
from lumped.result.result import Quantity

LIMIT = 0.01  # departure from the power law that counts as its end
LEAST = 1e-9  # departure below which rounding rules


@dataclass(frozen=True)
class Reach:
    """Depths over the row's length: tried `first` to `last`, the power law within 1 % up to `held` (with a bar).

    `departure`, shape (n,): force over the corrected row's, less one, at `depth`, the worst of all nu.
    """

    first: float
    last: float
    held: Quantity
    depth: Array
    departure: Array

    @property
    def throughout(self) -> bool:
        """Whether it holds at every depth tried."""
        return self.held.value == self.last


def reach(row: TableRow, curves: Mapping[float, Indentation], pressed: Mapping[float, tuple[Elastic, ...]]) -> Reach:
    """How deep the corrected row holds within 1 %, at every nu of the bodies that were pressed."""
    departures, bars = [], []
    for nu, curve in curves.items():
        departures.append(curve.force / row.force(curve.depth, *pressed[nu]) - 1.0)
        bars.append(curve.force_error / curve.force)
    every = np.array(departures)
    worst = every[np.abs(every).argmax(axis=0), np.arange(every.shape[1])]
    share = next(iter(curves.values())).depth / row.length
    held = _held(share, np.abs(worst), np.max(bars, axis=0))
    return Reach(float(share[0]), float(share[-1]), held, share, worst)


def _held(share: Array, departure: Array, bar: Array) -> Quantity:
    """The first depth at which a departure passes the limit, by a parabola through three depths, all in logarithms.

    Its bar: how far the bars of the forces move it, and how far it lies from the straight line's answer.
    """
    beyond = np.flatnonzero(departure > LIMIT)
    if not beyond.size:
        return Quantity(float(share[-1]), 0.0, "1")
    if beyond[0] == 0:
        return Quantity(0.0, float(share[0]), "1")
    end = int(beyond[0])
    near = slice(max(end - 2, 0), end + 1)
    x, y = np.log(share[near]), np.log(np.maximum(departure[near], LEAST) / LIMIT)
    slope = (y[-1] - y[-2]) / (x[-1] - x[-2])
    straight = x[-1] - y[-1] / slope
    roots = np.real(np.polynomial.Polynomial.fit(x, y, x.size - 1).roots())
    bent = float(roots[np.abs(roots - straight).argmin()])
    moved = abs(bent - straight) + float(bar[end]) / (LIMIT * slope)
    return Quantity(math.exp(bent), math.exp(bent) * math.expm1(moved), "1")
