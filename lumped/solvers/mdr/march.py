"""One impact of the row of springs: approach, then rebound, each a phase that is followed to its exact end.

In one step of the approach the edge stands where the profile meets the surface. A coarse march at its own pace is
quick, and good to about 1/elements^2.

How long the steps are: by the error they make, or as they were before, each cut into equal parts.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from lumped.errors import NotReached, TooManySteps
from lumped.result.history import AT_REST, End
from lumped.scene.geometry import stiffest_impact
from lumped.scene.scene import Scene
from lumped.solvers.mdr.memory import Fading, fadings
from lumped.solvers.mdr.retreat import retreat
from lumped.solvers.mdr.row import (
    Instant,
    Place,
    RowProblem,
    RowStep,
    Springs,
    SpringsInRow,
    Values,
    followed,
    followed_bend,
    stretched,
    yielding,
)

GROWTH = 3.0
CAUTION = 0.9
SHRINKAGE = 0.2
# Below this share of the velocity at touch, errors of the velocity count absolutely.
REST = 1e-5
# Once the contact has shrunk to this share of its reach, its edge may run to the axis in any step.
NEARLY_CLOSED = 0.1
OVERREACH = 1.5
LOCATING_STEPS = 60
CLOSE = 1e-13
SHORTEST = 1e-14
AT_END = 1.0 - 1e-12
SECANTS = 60
# The last correction of the rate; what is left after it is the product of two such.
CONVERGED = 1e-9
# Gauss' two points on (0, 1).
GAUSS = (0.5 - 0.5 / math.sqrt(3.0), 0.5 + 0.5 / math.sqrt(3.0))
MOST_STEPS = 10_000
# An end time is near a turn that comes before so many times it, and not more than so many steps before it.
FURTHER, NEAR = 1.2, 1.5


class Pace(Protocol):
    """Says how long the next step is to be, and whether a tried one may be taken."""

    def propose(self, now: Instant) -> float:
        """Length of the next step, s."""

    def accepts(self, now: Instant, then: Instant) -> bool:
        """Whether a step from `now` to `then` may be taken; if not, `propose` answers with a shorter one."""


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
        share = max(self._error(now, then, h), (CAUTION * self._travel(now, then)) ** 3)
        factor = GROWTH if share <= 0.0 else min(GROWTH, max(SHRINKAGE, CAUTION * share ** (-1.0 / 3.0)))
        self.h = h * factor
        if share > 2.0:
            return False
        self.before = now
        return True

    def _error(self, now: Instant, then: Instant, h: float) -> float:
        """Estimated error of the step over the tolerance."""
        return 0.0 if self.before is None else self.error(self.before, now, then)

    def error(self, before: Instant, now: Instant, then: Instant) -> float:
        """Estimated error of the step between the last two of three instants over the tolerance."""
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


@dataclass(frozen=True)
class Inward:
    """The row after an approach, its instants, and how the impact ended in it; None: with the turn."""

    row: SpringsInRow
    instants: list[Instant]
    end: End | None


@dataclass(frozen=True)
class RowTrack:
    """Instants of the approach, and of the rebound, which starts with the last of them; the end; energies there.

    `spent` in dashpots and `held` in springs, pressed or released, J. `beyond`: whole steps past an end by time.
    """

    approach: list[Instant]
    rebound: list[Instant]
    end: End
    spent: float
    held: float
    beyond: list[Instant]


def march(problem: RowProblem, end_time: float, pace: Pace, most: int, at_rest: float = AT_REST) -> RowTrack:
    """Follow one impact until separation or `end_time`, s.

    `pace` is that of the approach. Raises NotReached, TooManySteps after `most` steps of it.
    """
    return rebound(approach(problem, end_time, pace, most, at_rest), end_time)


def approach(problem: RowProblem, end_time: float, pace: Pace, most: int, at_rest: float = AT_REST) -> Inward:
    """The approach, to where the velocity is zero, or has died away in a fluid. Raises as `march` does."""
    row = SpringsInRow(problem)
    touch = Instant(0.0, 0.0, problem.velocity, problem.gravity, 0.0, 0.0)
    slow = at_rest * problem.velocity if problem.is_fluid and problem.gravity == 0.0 else 0.0
    growing = RowPhase(lambda now, h: grown(row, now, h), row.take, lambda step: step.now.velocity)
    instants, turned = growing.run(touch, pace, end_time, slow, most)
    rests = turned is None and instants[-1].velocity < slow
    return Inward(row, instants, None if turned else End.REST if rests else End.TIME)


def rebound(inward: Inward, end_time: float) -> RowTrack:
    """What follows an approach: until the spring at the axis carries no force, or gravity turns the striker again."""
    row, turn = inward.row, inward.instants[-1]
    if inward.end:
        return _track(inward, [], inward.end)
    if turn.acceleration >= 0.0:
        return _track(inward, [], End.SECOND_APPROACH)
    found = retreat(row, turn, end_time)
    return _track(inward, found.instants, found.end, found.beyond)


def _track(inward: Inward, outward: list[Instant], end: End, beyond: list[Instant] | None = None) -> RowTrack:
    row, last = inward.row, (outward or inward.instants)[-1]
    held = row.springs.held(row.problem.modulus, last.depth, row.even)
    return RowTrack(inward.instants, outward, end, 2.0 * row.spent, 2.0 * (row.released + held), beyond or [])


@dataclass(frozen=True)
class RowPhase:
    """How to try a step, how to take it, and what is `left` of the phase after it: at zero it is over."""

    attempt: Callable[[Instant, float], RowStep]
    take: Callable[[RowStep], None]
    left: Callable[[RowStep], float]

    def run(
        self, start: Instant, pace: Pace, end_time: float, slow: float, most: int
    ) -> tuple[list[Instant], RowStep | None]:
        """Steps until nothing is left, until `end_time`, or until the velocity has died away below `slow`.

        Returns the instants, and the step after which nothing was left (None in the other cases). Raises
        NotReached, and TooManySteps after `most` of them.
        """
        track, level = [start], start.velocity  # which is zero at the turn: what is left there is not known
        for _ in range(most):
            now = track[-1]
            h = min(pace.propose(now), end_time - now.time)
            if h <= SHORTEST * now.time:
                raise NotReached(f"the steps became too short at {now.time:.6g} s")
            step = self.attempt(now, h)
            if not pace.accepts(now, step.now):
                continue
            over = self.left(step) <= 0.0
            if over:
                step = self._located(now, step, level)
            self.take(step)
            track.append(step.now)
            level = self.left(step)
            if over or step.now.time >= AT_END * end_time or 0.0 < step.now.velocity < slow:
                return track, step if over else None
        raise TooManySteps(
            f"contact had not ended after {most} steps: accepted: a looser tolerance, an earlier end_time"
        )

    def _located(self, now: Instant, beyond: RowStep, level: float) -> RowStep:
        """The step from `now`, with `level` left, that ends with nothing left: secant in a bracket, Illinois."""
        low, high = 0.0, beyond.now.time - now.time
        miss_high = self.left(beyond)
        miss_low = level if level > 0.0 else -miss_high
        step, close, side = beyond, CLOSE * max(miss_low, -miss_high), 0
        for _ in range(LOCATING_STEPS):
            if -miss_high <= close:
                break
            h = high - miss_high * (high - low) / (miss_high - miss_low)
            if not low < h < high:
                h = 0.5 * (low + high)
            step = self.attempt(now, h)
            miss = self.left(step)
            if abs(miss) <= close:
                break
            if miss > 0.0:
                low, miss_low = h, miss
                miss_high *= 0.5 if side == 1 else 1.0
                side = 1
            else:
                high, miss_high = h, miss
                miss_low *= 0.5 if side == -1 else 1.0
                side = -1
        return step


def grown(row: SpringsInRow, now: Instant, h: float) -> RowStep:
    """A step of length h, s, not yet taken. Raises NotReached."""
    modulus = row.problem.modulus
    faded = fadings(modulus, h)
    rate, width, pressed = _rate(row, now, h, faded)
    rest = now.depth + rate * (h - pressed)
    shortly, fresh = fadings(modulus, pressed), [0.0] * len(faded)
    even, own = stretched(modulus, row.even, faded, rate), stretched(modulus, fresh, shortly, rate)
    joined = Springs.one(width, rest, [z - mine for z, mine in zip(even, own, strict=True)])
    springs = row.springs.aged([fade.left for fade in faded]).plus(joined)
    spent = row.springs.spent(modulus, row.even, faded, h, rate)
    spent += Springs(width, 0.0, 0.0, fresh, fresh).spent(modulus, fresh, shortly, pressed, rate)
    velocity, depth, edge = 2.0 * rate - now.velocity, now.depth + h * rate, now.edge + width
    axis = followed(modulus, row.axis, faded, now.velocity, velocity, h)
    kept = _kept(row, now, (velocity, edge, now.edge * rate + width * (depth - rest) / h), axis, faded, h)
    lately = [k - before * fade.left for k, before, fade in zip(kept, row.kept, faded, strict=True)]
    instant = row.instant(now.time + h, depth, velocity, edge, springs, axis, kept)
    place = Place(instant.time, depth, edge, axis, joined, lately)
    return RowStep(instant, springs, even, axis, kept, spent, 0.0, place)


def _kept(
    row: SpringsInRow, now: Instant, after: tuple[float, float, float], axis: Values, faded: list[Fading], h: float
) -> Values:
    """What all pressed springs lack, after a step, to as many like the one at the axis; with `after` the velocity and
    the edge then, and the mean of their product over the step: by so much the springs are stretched.
    """
    modulus, (velocity, edge, mean) = row.problem.modulus, after
    load = [now.edge * z - k for z, k in zip(row.axis, row.kept, strict=True)]
    load = followed_bend(modulus, load, faded, now.edge * now.velocity, mean, edge * velocity, h)
    return [edge * z - y for z, y in zip(axis, load, strict=True)]


def _rate(row: SpringsInRow, now: Instant, h: float, faded: list[Fading]) -> tuple[float, float, float]:
    """The rate at which the depth grows: m (v1 - v0) = m g h - int F dt with v0 + v1 twice the rate.

    With it what `_touched` says.
    """
    modulus, mass, width = row.problem.modulus, row.problem.mass, row.springs.width
    coasting = now.velocity + 0.5 * h * row.problem.gravity
    coasting -= row.springs.impulse(modulus, now.depth, row.even, faded, h) / mass
    give = yielding(modulus, faded, h) / mass
    rate, before, missed = now.velocity + 0.5 * h * now.acceleration, 0.0, 0.0
    for secant in range(SECANTS):
        wider, pressed = _touched(row, now, h, rate)
        own = wider * yielding(modulus, fadings(modulus, pressed), pressed) / mass if wider else 0.0
        miss = rate * (1.0 + width * give + own) - coasting
        slope = 1.0 + (width + wider) * give
        if secant and rate != before:
            slope = max((miss - missed) / (rate - before), 0.1 * slope)
        before, missed = rate, miss
        rate -= miss / slope
        if abs(rate - before) <= CONVERGED * (abs(now.velocity) + abs(rate)):
            return rate, wider, pressed
    raise NotReached("the velocity within one step of the spring row did not converge")


def _touched(row: SpringsInRow, now: Instant, h: float, rate: float) -> tuple[float, float]:
    """Width of the springs that a step touches, m, and for how long they are pressed, s, by their mean profile."""
    curve, depth = row.problem.shape.load_curve, now.depth + h * rate
    width = float(curve.contact_radius(depth)) - now.edge if rate > 0.0 else 0.0
    if width <= 0.0:
        return 0.0, 0.0
    low, high = (float(curve.depth(now.edge + share * width)) for share in GAUSS)
    return width, min(max((depth - 0.5 * (low + high)) / rate, 0.0), h)


def problem_of(scene: Scene) -> RowProblem:
    """What the row of springs needs of a scene."""
    return RowProblem(scene.profile, scene.contact_modulus, scene.reduced_mass, scene.velocity, scene.gravity)


def coarse(problem: RowProblem, end_time: float, elements: int) -> RowTrack:
    """One march with steps by their error and by the travel of the edge, 1/elements. Raises NotReached."""
    return march(problem, end_time, pace_of(problem, end_time, elements), MOST_STEPS)


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


def pace_of(problem: RowProblem, end_time: float, elements: int) -> Adaptive:
    """Its pace."""
    reach = stiffest_impact(problem.shape, problem.modulus, problem.mass, problem.velocity).contact_radius
    first = float(problem.shape.load_curve.depth(reach / elements)) / problem.velocity

    return Adaptive(min(first, end_time), elements, reach, problem.velocity)
