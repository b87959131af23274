"""Where the steps of an approach lie, so that they can be cut into equal parts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.solvers.mdr.row import Instant

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Grid:
    """Places of the steps of the approach, from 0 to 1, shape (n+1,), in the root of the time from touch.

    The contact radius grows like the root of the time from touch: in that root the motion is smooth, so the steps are
    cut into equal parts of it.
    """

    places: Array

    @classmethod
    def of(cls, instants: Sequence[Instant], weights: Array, intervals: int) -> Grid:
        """The grid of a march, resampled to at least `intervals`, each of its steps counted with a weight, (n,).

        The last step, cut by an event, counts by its length.
        """
        t = np.array([instant.time for instant in instants])
        roots = np.sqrt(t / t[-1])
        if t.size > 2:
            weights = np.append(weights[:-1], weights[-1] * min((roots[-1] - roots[-2]) / (roots[-2] - roots[-3]), 1.0))
        index = np.append(0.0, np.cumsum(weights))
        count = 2 * round(0.5 * max(intervals, float(index[-1])))  # even, so that every second place is a grid too
        return cls(np.interp(np.linspace(0.0, index[-1], count + 1), index, roots))

    @classmethod
    def through(cls, instants: Sequence[Instant]) -> Grid:
        """The grid of a march as it is."""
        t = np.array([instant.time for instant in instants])
        return cls(np.sqrt(t / t[-1]))

    def times(self, end: float, parts: int) -> list[float]:
        """Ends of the steps, s, each step of the grid cut into `parts`; the start itself is left out."""
        index = np.arange(1, parts * (self.places.size - 1) + 1) / parts
        times: list[float] = (end * monotone(self.places, index) ** 2).tolist()
        return times


def monotone(values: Array, index: Array) -> Array:
    """Ascending values, (n,), at whole numbers: the piecewise cubic between them that ascends, with a steady slope.

    Fritsch and Butland 1984, doi 10.1137/0905021: the slopes are harmonic means of those on either side.
    """
    rises = np.diff(values)
    inner = 2.0 * rises[:-1] * rises[1:] / (rises[:-1] + rises[1:])
    slopes = np.concatenate([rises[:1], inner, rises[-1:]])
    cell = np.clip(index.astype(int), 0, rises.size - 1)
    u, rise = index - cell, rises[cell]
    bend = (slopes[cell] - rise) * (1.0 - u) - (slopes[cell + 1] - rise) * u
    return np.asarray(values[cell] + u * rise + u * (1.0 - u) * bend)
