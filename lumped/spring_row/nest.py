"""Nested marches, the steps cut into 1, 2, 4, ... parts, and their limit by Richardson's rule.

The row of springs errs by h^2, so the difference of two marches tells the limit, and the difference of two such
limits is a true bar for the better one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.spring_row.grid import Grid
from lumped.spring_row.march import End, Track, march
from lumped.spring_row.pace import Pace, Prescribed
from lumped.spring_row.row import Instant, Problem

Array = NDArray[np.float64]
ALIGNING_TRIES = 8


@dataclass(frozen=True)
class Level:
    """One march: its columns (those of Instant, then rows) for approach and rebound, and the number of steps."""

    approach: Array
    rebound: Array
    steps: int

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
        """The grids of a coarse march, at least `intervals` for each phase, and more for a phase of many steps."""
        if track.end is End.REST:
            end_time = track.approach[-1].time

        def grid(instants: list[Instant], from_end: bool) -> Grid:
            return Grid.of(instants, max(intervals, len(instants)), from_end)

        rebound = grid(track.rebound, track.end is End.SEPARATED) if track.rebound else None
        return cls(problem, end_time, grid(track.approach, False), rebound)

    def level(self, parts: int, ends: tuple[float, float]) -> Level:
        """March with every step cut into `parts`, again with better `ends` until the phases end in their last steps."""
        for _ in range(ALIGNING_TRIES):
            track = self._march(parts, ends)
            level = Level(_columns(track.approach), _columns(track.rebound), len(track.approach) + len(track.rebound))
            if self._aligned(level, parts):
                break
            ends = level.ends
        return level

    def _march(self, parts: int, ends: tuple[float, float]) -> Track:
        turn, last = ends

        def pace(start: Instant) -> Pace:
            grid = self.approach if start.time == 0.0 or self.rebound is None else self.rebound
            return Prescribed(grid.times(start.time, turn if start.time == 0.0 else last, parts))

        return march(self.problem, self.end_time, pace, 10 * parts * self.approach.places.size)

    def _aligned(self, level: Level, parts: int) -> bool:
        grown = level.approach.shape[1] == parts * (self.approach.places.size - 1) + 1
        if self.rebound is None:
            return grown and not level.rebound.size
        return grown and level.rebound.shape[1] == parts * (self.rebound.places.size - 1) + 1


def limit(coarse: Level, fine: Level) -> Level:
    """Richardson's limit of two marches, the finer of twice the steps, on the rows of the finer.

    The correction is known on every second row, and is smooth: between them it is the mean of its neighbours.
    """
    return Level(_limit(coarse.approach, fine.approach), _limit(coarse.rebound, fine.rebound), fine.steps)


def _limit(coarse: Array, fine: Array) -> Array:
    if not fine.size:
        return fine
    correction = np.empty_like(fine)
    correction[:, ::2] = (fine[:, ::2] - coarse) / 3.0
    correction[:, 1::2] = 0.5 * (correction[:, :-2:2] + correction[:, 2::2])
    return np.asarray(fine + correction)


def _columns(instants: list[Instant]) -> Array:
    return np.array(instants, dtype=float).T
