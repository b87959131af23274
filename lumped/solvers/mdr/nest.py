"""Nested marches, the steps cut into 1, 2, 4, ... parts, and their limits by Richardson's rule.

The row of springs errs by even powers of h: the limit of two marches errs by h^4, that of three by h^6.

Where the steps of an approach lie, so that they can be cut into equal parts. The first are as long as a coarse march
at its own pace has them, by the error they make: that one is quick, and good to about 1/elements^2.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from lumped.errors import NotReached
from lumped.numbers import Array, local
from lumped.result.history import End
from lumped.scene.geometry import stiffest_impact
from lumped.scene.scene import Scene
from lumped.solvers.mdr.march import Inward, RowTrack, approach, rebound, track_of
from lumped.solvers.mdr.row import Instant, RowProblem

# Work: marches until the turn falls on a step; safety: the secant's slope is no flatter.
ALIGNING_TRIES, LEAST_SLOPE = 12, -0.3
NEARLY = 1e-3  # of the last step before the turn: how near to its end the turn has to lie
GROWTH = 3.0  # safety: the most by which the next step is longer
CAUTION = 0.9  # safety: share of what the error, or the edge's travel, allows
SHRINKAGE = 0.2  # safety: the least by which the next step is longer
# Below this share of the velocity at touch, errors of the velocity count absolutely.
REST = 1e-5
# Once the contact has shrunk to this share of its reach, its edge may run to the axis in any step.
NEARLY_CLOSED = 0.1
OVERREACH = 1.5  # safety: the last step over its own length, so that it reaches beyond the event that cuts it
MOST_STEPS = 10_000  # work: of one coarse march
# An end time is near a turn that comes before so many times it, and not more than so many steps before it.
FURTHER, NEAR = 1.2, 1.5
# Of a march: elements over those of other coarse ones, safety; the last of its steps but these, since it errs itself.
SHARPER, SURE = 4, 3


@dataclass
class Adaptive:
    """Steps that keep the error of the velocity below `tolerance` of it, and the edge's travel below 1/elements.

    The error of a step is h^3 a''/12, a'' from the accelerations at three instants. `reach`, m: the contact
    radius which `elements` steps are to cover at least.
    """

    first: float
    elements: int
    reach: float
    velocity: float
    tolerance: float = field(init=False)
    before: Instant | None = None
    h: float = field(init=False)

    def __post_init__(self) -> None:
        # A half sine of acceleration errs by this per step at 0.6 `elements` steps per contact.
        self.tolerance = 12.0 / self.elements**3
        self.h = self.first

    def propose(self, now: Instant) -> float:
        return self.h

    def accepts(self, now: Instant, then: Instant) -> bool:
        h = then.time - now.time
        # An error grows as h^3, the travel as h: cubed, both ask for a step in the same way.
        share = max(self.error(self.before, now, then), (CAUTION * self._travel(now, then)) ** 3)
        factor = GROWTH if share <= 0.0 else min(GROWTH, max(SHRINKAGE, CAUTION * share ** (-1.0 / 3.0)))
        self.h = h * factor
        if share > 2.0:
            return False
        self.before = now
        return True

    def error(self, before: Instant | None, now: Instant, then: Instant) -> float:
        """Estimated error of the step between the last two of three instants over the tolerance; zero of the first."""
        if before is None:
            return 0.0
        h, back = then.time - now.time, now.time - before.time
        if not h > 0.0 or not back > 0.0:
            return 0.0
        bend = (then.acceleration - now.acceleration) / h - (now.acceleration - before.acceleration) / back
        scale = max(abs(now.velocity), abs(then.velocity), REST * self.velocity)
        return abs(h**3 * bend / (6.0 * (h + back))) / (self.tolerance * scale)

    def _travel(self, now: Instant, then: Instant) -> float:
        """The edge's travel over its allowance."""
        if then.edge < now.edge and then.edge < NEARLY_CLOSED * self.reach:
            return 0.0
        allowed = max(now.edge, then.edge, self.reach) / self.elements
        return abs(then.edge - now.edge) / allowed


@dataclass
class Prescribed:
    """Steps that end at given instants, s; the last reaches beyond its own, for the event that cuts it."""

    instants: Sequence[float]
    taken: int = 0

    def propose(self, now: Instant) -> float:
        if self.taken < len(self.instants) - 1:
            return self.instants[self.taken] - now.time
        return OVERREACH * (self.instants[-1] - (self.instants[-2] if len(self.instants) > 1 else 0.0))

    def accepts(self, now: Instant, then: Instant) -> bool:
        self.taken += 1
        return True


def problem_of(scene: Scene) -> RowProblem:
    """What the row of springs needs of a scene."""
    return RowProblem(scene.profile, scene.contact_modulus, scene.reduced_mass, scene.velocity, scene.gravity)


def coarse(problem: RowProblem, end_time: float, elements: int) -> RowTrack:
    """One march with steps by their error and by the travel of the edge, 1/elements. Raises NotReached."""
    inward = approach(problem, end_time, pace_of(problem, end_time, elements), MOST_STEPS)
    return rebound(inward, end_time, doubted=True)


def coarse_beyond(problem: RowProblem, end_time: float, elements: int) -> tuple[RowTrack, float]:
    """One march with when it stops, s: at the end time or, where that lies within some steps of the turn, beyond both.

    Finer marches than this turn at other times: if all go further none of them is cut short of the turn, or by it.
    Raises NotReached.
    """
    track = coarse(problem, end_time, elements)
    if track.end is not End.TIME:
        return track, end_time
    further = coarse(problem, FURTHER * end_time, elements)
    if not further.rebound:
        return track, end_time
    *_, before, last, turn = (instant.time for instant in further.approach)
    later = max(end_time, turn) + 2.0 * NEAR * (last - before)
    if end_time > turn + NEAR * (last - before):
        return track, end_time
    beyond = coarse(problem, later, elements)
    return (beyond, later) if beyond.end is End.TIME else (track, end_time)


def shrinks_until(problem: RowProblem, end_time: float, elements: int) -> float | None:
    """Until when, s, the edge is seen to shrink that turns under gravity before the end time; None where it does not.

    Zero where it does as soon as the striker turns, or a few steps later. Raises NotReached.
    """
    track = coarse(problem, end_time, SHARPER * elements) if problem.gravity > 0.0 else None
    if track is None or track.end is not End.SECOND_APPROACH:
        return None
    return track.rebound[-SURE].time if len(track.rebound) > SURE else 0.0


def pace_of(problem: RowProblem, end_time: float, elements: int) -> Adaptive:
    """Its pace."""
    reach = stiffest_impact(problem.shape, problem.modulus, problem.mass, problem.velocity).contact_radius
    first = float(problem.shape.load_curve.depth(reach / elements)) / problem.velocity

    return Adaptive(min(first, end_time), elements, reach, problem.velocity)


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

    @property
    def within_step(self) -> bool:
        """Whether it ends by time in a step of the rebound, and no whole step leads on from there."""
        return self.end is End.TIME and self.rebound.size > 0 and bool(self.rebound[0, -1] <= self.last)


@dataclass(frozen=True)
class Nest:
    """A problem, when to stop (s), the grid of its approach, and whether the striker counts as at rest then.

    `cut`: when the history is to end, s, where marches go on beyond it; `turns`: whether it ends with the approach.
    """

    problem: RowProblem
    end_time: float
    grid: Grid
    rests: bool = False
    cut: float | None = None
    turns: bool = False

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
        inward, half = self._approach(times, self.end_time), self._approach(times[1::2], self.end_time)
        level = self._level(self._back(inward), times, len(inward.instants) + len(half.instants))
        return replace(self, grid=Grid.through(inward.instants)), level, half.instants[-1].time

    def _approach(self, times: list[float], end: float) -> Inward:
        return approach(self.problem, end, Prescribed(times), 2 * len(times), at_rest=0.0)

    def _back(self, inward: Inward) -> RowTrack:
        return track_of(inward, End.SECOND_APPROACH) if self.turns else rebound(inward, self.end_time)

    def level(self, parts: int, turn: float) -> Level:
        """March with every step cut into `parts`, again with a better time of the turn, s, until that is met.

        Raises NotReached when it never is.
        """
        steps, tried, missed = 0, 0.0, 0.0
        for _ in range(ALIGNING_TRIES):
            times = self.grid.times(turn, parts)
            inward = self._approach(times, self.end_time)
            steps += len(inward.instants)
            *_, before, last = (instant.time for instant in inward.instants)
            if len(inward.instants) == len(times) + 1 and abs(last - turn) <= NEARLY * (last - before):
                return self._level(self._back(inward), times, steps)
            # The turn hardly depends on where it was expected, mostly: the slope is -1, else the secant's.
            slope = min((last - turn - missed) / (turn - tried), LEAST_SLOPE) if tried else -1.0
            tried, missed = turn, last - turn
            turn -= missed / slope
        raise NotReached("finer and coarser steps of the spring row do not follow the same course of events")

    def _level(self, track: RowTrack, times: list[float], steps: int) -> Level:
        if track.end is End.SECOND_APPROACH and track.rebound:
            raise NotReached("steps of the spring row finer than the first ones see its edge turn", "--method ting")
        steps += len(track.rebound) + len(track.beyond)
        outward = [*track.rebound[:-1], *track.beyond] if track.beyond else track.rebound
        whole = track if self.cut is None else rebound(self._approach(times, self.cut), self.cut)
        mass, last = self.problem.mass, (whole.rebound or whole.approach)[-1]
        motion = [mass * self.problem.gravity * last.depth, 0.5 * mass * last.velocity**2]
        energies = np.array([*motion, whole.spent, whole.held])
        end = End.REST if self.rests else track.end
        stop = np.array(last, dtype=float)
        return Level(_columns(track.approach), _columns(outward), stop, end, last.time, steps, energies)


def predicted_turn(before: float, last: float) -> float:
    """When the approach of the next level will end, s: the difference of those of the last two falls by 4."""
    return last + 0.25 * (last - before)


def alike(coarse: Level, fine: Level) -> bool:
    """Whether both end in the same way, on the same side of the turn: just before the end time they may not."""
    return coarse.end is fine.end and bool(coarse.rebound.size) == bool(fine.rebound.size)


def limit(coarse: Level, fine: Level, order: int) -> Level:
    """Richardson's limit of two which err by this power of h, the finer of twice the steps, on the rows of the finer.

    The correction is known on every second row, and is smooth. The two are :func:`alike`.
    """
    gain = 1.0 / (2.0**order - 1.0)
    one, finer = coarse.rebound, fine.rebound
    stop = fine.stop + gain * (fine.stop - coarse.stop)
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
