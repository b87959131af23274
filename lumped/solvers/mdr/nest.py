"""Nested marches, the steps cut into 1, 2, 4, ... parts, and their limits by Richardson's rule.

The row of springs errs by even powers of h: the limit of two marches errs by h^4, that of three by h^6.

Where the steps of an approach lie, so that they can be cut into equal parts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lumped.errors import NotReached
from lumped.numbers.interpolation import local
from lumped.result.history import End
from lumped.solvers.mdr.march import Adaptive, Inward, Prescribed, RowTrack, approach, rebound
from lumped.solvers.mdr.row import Instant, RowProblem

Array = NDArray[np.float64]
ALIGNING_TRIES, LEAST_SLOPE = 12, -0.3
NEARLY = 1e-3


@dataclass(frozen=True)
class Level:
    """One march, or a limit of several.

    The fields of Instant over the steps of approach and rebound, shape (6, n), whole ones past an end by time where
    the edge goes on past it; those at the end, (6,); how and when, s, it ended; steps marched for it; energies at the
    end, J: that of the motion, (2,) as work of gravity and left, spent in dashpots, held in springs.
    """

    approach: Array
    rebound: Array
    stop: Array
    end: End
    last: float
    steps: int
    energies: Array

    @property
    def turn(self) -> float:
        """When the striker turns, s."""
        return float(self.approach[0, -1])


@dataclass(frozen=True)
class Nest:
    """A problem, when to stop (s), the grid of its approach, and whether the striker counts as at rest then.

    `cut`: when the history is to end, s, where marches go on beyond it.
    """

    problem: RowProblem
    end_time: float
    grid: Grid
    rests: bool = False
    cut: float | None = None

    @classmethod
    def around(cls, problem: RowProblem, end_time: float, track: RowTrack, pace: Adaptive, intervals: int) -> Nest:
        """The grid of a coarse march at this pace, denser where the rebound needs it. Raises NotReached.

        It has `intervals` where the march has the steps that its pace has elements, else more or fewer in proportion.
        What comes to rest keeps the march's own: fewer would swing about it.
        """
        if track.end is End.REST:
            end_time, intervals = track.approach[-1].time, pace.elements
        weights = np.full(len(track.approach) - 1, intervals / pace.elements)
        back = track.rebound
        for i in range(2, len(back)):
            share = pace.error(back[i - 2], back[i - 1], back[i])
            weights[-i] *= max(1.0, share ** (1.0 / 3.0))
        return cls(problem, end_time, Grid.of(track.approach, weights, intervals), track.end is End.REST)

    def begun(self, turn: float) -> tuple[Nest, Level, float]:
        """The nest whose grid is that of its coarsest march, with an expected time of the turn, s; that march.

        And when one of half as many steps turns, s: it tells when the finer ones will.
        """
        times = self.grid.times(turn, 1)
        inward, half = self._approach(times), self._approach(times[1::2])
        level = self._level(rebound(inward, self.end_time), times, len(inward.instants) + len(half.instants))
        return replace(self, grid=Grid.through(inward.instants)), level, half.instants[-1].time

    def _approach(self, times: list[float]) -> Inward:
        return approach(self.problem, self.end_time, Prescribed(times), 2 * len(times), at_rest=0.0)

    def level(self, parts: int, turn: float) -> Level:
        """March with every step cut into `parts`, again with a better time of the turn, s, until that is met.

        Raises NotReached when it never is.
        """
        steps, tried, missed = 0, 0.0, 0.0
        for _ in range(ALIGNING_TRIES):
            times = self.grid.times(turn, parts)
            inward = self._approach(times)
            steps += len(inward.instants)
            *_, before, last = (instant.time for instant in inward.instants)
            if len(inward.instants) == len(times) + 1 and abs(last - turn) <= NEARLY * (last - before):
                return self._level(rebound(inward, self.end_time), times, steps)
            # The turn hardly depends on where it was expected, mostly: the slope is -1, else the secant's.
            slope = min((last - turn - missed) / (turn - tried), LEAST_SLOPE) if tried else -1.0
            tried, missed = turn, last - turn
            turn -= missed / slope
        raise NotReached("finer and coarser steps of the spring row do not follow the same course of events")

    def _level(self, track: RowTrack, times: list[float], steps: int) -> Level:
        steps += len(track.rebound) + len(track.beyond)
        outward = [*track.rebound[:-1], *track.beyond] if track.beyond else track.rebound
        ended = track if self.cut is None else self._ended(times, self.cut)
        mass, last = self.problem.mass, (ended.rebound or ended.approach)[-1]
        motion = [mass * self.problem.gravity * last.depth, 0.5 * mass * last.velocity**2]
        energies = np.array([*motion, ended.spent, ended.held])
        end = End.REST if self.rests else track.end
        stop = np.array(last, dtype=float)
        return Level(_columns(track.approach), _columns(outward), stop, end, last.time, steps, energies)

    def _ended(self, times: list[float], cut: float) -> RowTrack:
        """The march of these steps to where the history ends."""
        return rebound(approach(self.problem, cut, Prescribed(times), 2 * len(times), at_rest=0.0), cut)


def predicted_turn(before: float, last: float) -> float:
    """When the approach of the next level will end, s: the difference of those of the last two falls by 4."""
    return last + 0.25 * (last - before)


def limit(coarse: Level, fine: Level, order: int) -> Level:
    """Richardson's limit of two which err by this power of h, the finer of twice the steps, on the rows of the finer.

    The correction is known on every second row, and is smooth. Raises NotReached where the two end differently.
    """
    if coarse.end is not fine.end:
        raise NotReached("finer and coarser steps of the spring row end differently")
    gain = 1.0 / (2.0**order - 1.0)
    one, finer = coarse.rebound, fine.rebound
    stop = fine.stop + gain * (fine.stop - coarse.stop)
    if bool(one.size) != bool(finer.size):
        raise NotReached("finer and coarser steps of the spring row turn on either side of the end time")
    if finer.size and fine.end is End.TIME:
        one, finer = _whole(one, finer)
        if finer[0, -1] <= fine.last:
            one, finer = _cut(_stopped(coarse), _stopped(fine))
    elif finer.size and fine.end is not End.SEPARATED:
        one, finer = _cut(one, finer)
    energies = fine.energies + gain * (fine.energies - coarse.energies)
    approach = _limit(coarse.approach, fine.approach, gain)
    back = _limit(one, finer, gain)
    last = fine.last if fine.end is End.TIME else float((back if back.size else approach)[0, -1])
    return Level(approach, back, stop, fine.end, last, fine.steps, energies)


def _whole(coarse: Array, fine: Array) -> tuple[Array, Array]:
    """Two rebounds of whole steps, as far as both go."""
    both = min(coarse.shape[1] - 1, (fine.shape[1] - 1) // 2)
    return coarse[:, : both + 1], fine[:, : 2 * both + 1]


def _stopped(level: Level) -> Array:
    """A rebound up to its end by time, within a step: where the edge comes to rest before, no whole one leads past."""
    back = level.rebound
    return np.column_stack([back[:, back[0] < level.last], level.stop])


def _cut(coarse: Array, fine: Array) -> tuple[Array, Array]:
    """Two rebounds that end within a step: the last rows, and of those before as many as both have."""
    both = min(coarse.shape[1] - 1, fine.shape[1] // 2)
    return np.delete(coarse, np.s_[both:-1], axis=1), np.delete(fine, np.s_[2 * both - 1 : -1], axis=1)


def _limit(coarse: Array, fine: Array, gain: float) -> Array:
    """The limit on the rows of the finer, of which the coarser has every second, and the last."""
    if not fine.size:
        return fine
    known = np.append(np.arange(0, fine.shape[1] - 1, 2), fine.shape[1] - 1)
    if known.size != coarse.shape[1]:
        raise NotReached("finer and coarser steps of the spring row do not follow the same course of events")
    correction = np.empty_like(fine)
    correction[:, known] = gain * (fine[:, known] - coarse)
    between = known[1:][np.diff(known) > 1] - 1
    correction[:, between] = local(known.astype(float), correction[:, known], between.astype(float))
    return np.asarray(fine + correction)


def _columns(instants: list[Instant]) -> Array:
    return np.array(instants, dtype=float).T


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
