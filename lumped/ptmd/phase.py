"""A phase: the motion between two switches, in rows close enough that nothing happens unseen between two of them.

A phase ends where a level falls through zero between two rows. What is asked is the sign of a level at its located
lowest place or at the end of a row. No sign is asked where a level is zero but for rounding: there its slope says where
it goes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.errors import BadInput, Fault
from lumped.ptmd.equations import Equations, Stages, Switch
from lumped.ptmd.system import Start

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
ROWS_PER_PERIOD = 64  # default: rows in the shortest period
# Beyond this ratio of row to relaxation time the exponentials of a phase lose the digits that are promised.
STIFFEST = 1e5
NEAREST = 40  # halvings of a row in which a contact that has just begun is looked for
STILL = 1e-7  # of the steepest slope of a row: less takes a level 1e-14 of its change below zero, which is rounding


@dataclass(frozen=True, eq=False)
class PtmdPhase:
    """Rows of time, s, shape (k,), and of the state, shape (size, k), from the start to the end of a phase.

    `at` maps a time inside to the state there; `integrals` maps it to the integrals of the equations'
    integrands since the start of the phase, shape (6,).
    """

    stages: Stages
    times: Array
    states: Array
    at: Callable[[float], Array]
    integrals: Callable[[float], Array]

    @property
    def start(self) -> float:
        """First instant, s."""
        return float(self.times[0])

    @property
    def end(self) -> float:
        """Last instant, s."""
        return float(self.times[-1])


Follow = Callable[[Stages, Array, float], tuple[PtmdPhase, Switch | None]]


def row_spacing(equations: Equations, start: Start, end_time: float, rows: int, most: int) -> float:
    """Time between two of ``rows`` a period, s: a share of the shortest one, the ring as stiff as it can be.

    Raises BadInput when the rows would be more than ``most`` or the ring relaxes far too fast for them.
    """
    spacing = 2.0 * np.pi / (rows * fastest(equations, start))
    if end_time > spacing * most:
        message = f"more than {most} rows; accepted: at most {spacing * most:.3g} s for these oscillators"
        raise BadInput(Fault("motion", "end_time", message))
    shortest = STIFFEST**-1 * spacing
    if equations.surface is not None:
        stiffness = equations.surface.stiffness
        creep = [stiffness.viscosity / stiffness.glassy] if stiffness.viscosity and stiffness.glassy else []
        if min([*stiffness.times, *creep], default=shortest) < shortest:
            message = f"relaxes in less than {shortest:.2g} s, too fast beside the vibration; cure: leave that term out"
            raise BadInput(Fault("ring", "material", message))
    return float(spacing)


def fastest(equations: Equations, start: Start) -> float:
    """Highest angular frequency, 1/s, of the undamped system with its ring pressed and not relaxed."""
    one, two = equations.system.structure, equations.system.damper
    if two is None:
        return float(np.sqrt(one.stiffness / one.mass))
    link = two.stiffness + _steepest(equations, start)
    roots = np.diag([one.mass, two.mass]) ** 0.5
    stiffness = np.array([[one.stiffness + link, -link], [-link, link]])
    scaled = np.linalg.solve(roots, np.linalg.solve(roots, stiffness).T)
    return float(np.sqrt(np.linalg.eigvalsh(scaled)[-1]))


def _steepest(equations: Equations, start: Start) -> float:
    """Largest slope of the ring's force over the depth, N/m, with all the energy of the start in it."""
    ring = equations.system.ring
    if ring is None or ring.stiffness.glassy == 0.0:
        return 0.0
    y = equations.initial(start)
    energy, power = equations.kinetic(y) + equations.potential(y), ring.exponent
    deepest = ((power + 1.0) * energy / ring.stiffness.glassy) ** (1.0 / (power + 1.0))
    return float(power * ring.stiffness.glassy * deepest ** (power - 1.0))


@dataclass(frozen=True, eq=False)
class LevelRow:
    """A level between two rows, `length` s apart: `level` and its `rate` map a state, `at` an offset, s, to a state.

    Offsets closer than `resolution`, s, have one value.
    """

    level: Callable[[Array], float]
    rate: Callable[[Array], float]
    at: Callable[[float], Array]
    length: float
    resolution: float = 0.0

    def value(self, offset: float) -> float:
        """The level."""
        return self.level(self.at(offset))

    def slope(self, offset: float) -> float:
        """Its rate."""
        return self.rate(self.at(offset))


def first_row(
    lengths: Array, levels: Array, slopes: Array, begun: Flags, rows: Callable[[int], Sequence[LevelRow]]
) -> tuple[int, float, int] | None:
    """Row, offset in it, s, and index of the level that falls first in k rows; None where none does.

    `levels` and `slopes`, shape (m, k + 1), where the rows begin and end; `begun` (m,), see :func:`first_fall`, of the
    first; `rows` gives every level between two of them.
    """
    suspects = _suspect(lengths, levels, slopes)
    suspects[0] |= begun.any()
    for i in np.flatnonzero(suspects).tolist():
        found = first_fall(rows(i), (begun & (i == 0)).tolist())
        if found is not None:
            return i, *found
    return None


def _suspect(lengths: Array, levels: Array, slopes: Array) -> Flags:
    """Rows, shape (k,), in which a level may fall: it ends at or below zero, or it dips and comes back.

    `levels` and `slopes`, shape (m, k + 1), where the rows begin and end.
    """
    below = levels[:, 1:] <= 0.0
    turns = (slopes[:, :-1] < 0.0) & (slopes[:, 1:] > 0.0)
    near = levels[:, :-1] + 2.0 * slopes[:, :-1] * lengths <= 0.0
    return np.asarray(np.any(below | (turns & near), axis=0))


def first_fall(rows: Sequence[LevelRow], begun: Sequence[bool]) -> tuple[float, int] | None:
    """Offset, s, and index of the level that falls first; None where none does.

    `begun`: a phase begins here and the level is zero, but for the rounding of the switch before.
    """
    found = [_from_zero(row) if zero else _from_above(row) for row, zero in zip(rows, begun, strict=True)]
    return min(((offset, index) for index, offset in enumerate(found) if offset is not None), default=None)


def _from_above(row: LevelRow) -> float | None:
    """Offset of the first fall of a level that starts above zero. Rows are so close that it turns but once."""
    if row.value(row.length) <= 0.0:
        return _root(row, row.value, 0.0, row.length)
    if not row.slope(0.0) < 0.0 < row.slope(row.length):
        return None
    lowest = _root(row, lambda offset: -row.slope(offset), 0.0, row.length)
    return _root(row, row.value, 0.0, lowest) if row.value(lowest) < 0.0 else None


def _from_zero(row: LevelRow) -> float | None:
    """Offset of the first fall of a level that starts at zero: none, at once, or after a rise, however short."""
    start, end = row.slope(0.0), row.slope(row.length)
    if start < -STILL * max(abs(start), abs(end)):
        return 0.0
    offset = row.length
    for _ in range(NEAREST):
        if row.value(offset) > 0.0:
            return None if offset == row.length else _root(row, row.value, offset, 2.0 * offset)
        offset *= 0.5
    return 0.0


def _root(row: LevelRow, function: Callable[[float], float], low: float, high: float) -> float:
    """Where a function falls through zero that is above it at `low` and not at `high`, as far as rounding lets it."""
    from scipy.optimize import brentq

    if function(low) <= 0.0:
        return low
    if function(high) >= 0.0:
        return high
    # Below the resolution a function is a staircase, on which the search would halve without end.
    return float(brentq(function, low, high, xtol=max(row.resolution, 1e-300), rtol=1e-14))
