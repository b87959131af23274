"""Where the steps of a phase lie, so that they can be cut into equal parts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.errors import NotReached
from lumped.spring_row.row import Instant

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Grid:
    """Places of the steps of one phase, from 0 to 1, shape (n+1,), in the root of time from its singular end.

    The contact radius grows like the root of the time from touch, and shrinks to nothing like the root of the
    time left. In that root the motion is smooth, so the steps are cut into equal parts of it.
    """

    places: Array
    from_end: bool

    @classmethod
    def of(cls, instants: list[Instant], intervals: int, from_end: bool) -> Grid:
        """The grid of a march, resampled to `intervals`; its last step, cut by an event, counts by its length.

        Raises NotReached for a phase without length.
        """
        t = np.array([instant.time for instant in instants])
        span = t[-1] - t[0]
        if span <= 0.0:
            raise NotReached("the rebound ends where it starts: gravity and the target are in balance there")
        roots = 1.0 - np.sqrt((t[-1] - t) / span) if from_end else np.sqrt((t - t[0]) / span)
        index = np.arange(t.size, dtype=float)
        if t.size > 2:
            index[-1] = index[-2] + min((roots[-1] - roots[-2]) / (roots[-2] - roots[-3]), 1.0)
        return cls(np.interp(np.linspace(0.0, index[-1], intervals + 1), index, roots), from_end)

    def times(self, start: float, end: float, parts: int) -> list[float]:
        """Ends of the steps, s, each step of the grid cut into `parts`; `start` itself is left out."""
        whole = np.arange(self.places.size, dtype=float)
        roots = np.interp(np.arange(1, parts * (whole.size - 1) + 1) / parts, whole, self.places)
        shares = 1.0 - (1.0 - roots) ** 2 if self.from_end else roots**2
        times: list[float] = (start + (end - start) * shares).tolist()
        return times
