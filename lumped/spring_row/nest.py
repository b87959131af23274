"""Nested marches, the steps cut into 1, 2, 4, ... parts, and their limit by Richardson's rule.

The row of springs errs by h^2, so the difference of two marches tells the limit, and the difference of two
such limits is a true bar for the better one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.ending import End
from lumped.errors import NotReached
from lumped.spring_row.energy import Meter
from lumped.spring_row.grid import Grid
from lumped.spring_row.march import Track, march
from lumped.spring_row.pace import Pace, Prescribed
from lumped.spring_row.row import Instant, Problem, Row

Array = NDArray[np.float64]
ALIGNING_TRIES = 8
NEARLY = 0.05


@dataclass(frozen=True)
class Level:
    """One march, or the limit of two.

    The fields of Instant over the steps of approach and rebound, shape (6, n); steps marched for it; energies, J.
    """

    approach: Array
    rebound: Array
    steps: int
    energies: Array

    @property
    def ends(self) -> tuple[float, float]:
        """When the striker turns, and when the history ends, s."""
        return float(self.approach[0, -1]), float((self.rebound if self.rebound.size else self.approach)[0, -1])


@dataclass(frozen=True)
class Nest:
    """A problem, when to stop (s), and the grids of its phases (no rebound: None)."""

    problem: Problem
    end_time: float
    approach: Grid
    rebound: Grid | None

    @classmethod
    def around(cls, problem: Problem, end_time: float, track: Track, intervals: int) -> Nest:
        """The grids of a coarse march, at least `intervals` for each phase, and no fewer than its steps."""
        if track.end is End.REST:
            end_time = track.approach[-1].time

        def grid(instants: list[Instant], from_end: bool) -> Grid:
            return Grid.of(instants, max(intervals, len(instants)), from_end)

        rebound = grid(track.rebound, track.end is End.SEPARATED) if track.rebound else None
        return cls(problem, end_time, grid(track.approach, False), rebound)

    def level(self, parts: int, ends: tuple[float, float]) -> Level:
        """March with every step cut into `parts`, again with better `ends` (s) until the phases end as planned.

        Raises NotReached when they never do.
        """
        steps = 0
        for _ in range(ALIGNING_TRIES):
            meter = Meter(self.problem)
            track = self._march(parts, ends, meter.observe)
            steps += len(track.approach) + len(track.rebound)
            level = Level(_columns(track.approach), _columns(track.rebound), steps, meter.energies)
            if self._aligned(level, parts, ends):
                return level
            ends = level.ends
        raise NotReached("finer and coarser steps of the spring row do not follow the same course of events")

    def _march(self, parts: int, ends: tuple[float, float], observe: Callable[[Row, Instant], None]) -> Track:
        turn, last = ends

        def pace(start: Instant) -> Pace:
            grid = self.approach if start.time == 0.0 or self.rebound is None else self.rebound
            return Prescribed(grid.times(start.time, turn if start.time == 0.0 else last, parts))

        most = 10 * parts * max(self.approach.places.size, self.rebound.places.size if self.rebound else 0)
        return march(self.problem, self.end_time, pace, most, at_rest=0.0, observe=observe)

    def _aligned(self, level: Level, parts: int, ends: tuple[float, float]) -> bool:
        """Whether each phase has the planned number of steps, and its last one nearly the planned length."""
        phases = [(level.approach, self.approach, ends[0]), (level.rebound, self.rebound, ends[1])]
        for fields, grid, end in phases:
            if fields.size == 0 or grid is None:
                if fields.size or grid:
                    return False
                continue
            time = fields[0]
            if time.size != parts * (grid.places.size - 1) + 1 or abs(time[-1] - end) > NEARLY * (time[-1] - time[-2]):
                return False
        return True


def predicted_ends(levels: Sequence[Level]) -> tuple[float, float]:
    """When the phases of the next level will end, s: the difference of the last two falls by 4."""
    last = levels[-1].ends
    before = levels[-2].ends if len(levels) > 1 else last
    turn, end = (now + 0.25 * (now - earlier) for now, earlier in zip(last, before, strict=True))
    return turn, end


def limit(coarse: Level, fine: Level) -> Level:
    """Richardson's limit of two marches, the finer of twice the steps, on the rows of the finer.

    The correction is known on every second row, and is smooth: between them it is the mean of its neighbours.
    """
    energies = (4.0 * fine.energies - coarse.energies) / 3.0
    return Level(_limit(coarse.approach, fine.approach), _limit(coarse.rebound, fine.rebound), fine.steps, energies)


def _limit(coarse: Array, fine: Array) -> Array:
    if not fine.size:
        return fine
    correction = np.empty_like(fine)
    correction[:, ::2] = (fine[:, ::2] - coarse) / 3.0
    correction[:, 1::2] = 0.5 * (correction[:, :-2:2] + correction[:, 2::2])
    return np.asarray(fine + correction)


def _columns(instants: list[Instant]) -> Array:
    return np.array(instants, dtype=float).T
