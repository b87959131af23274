"""One impact of the row of springs: approach, then rebound, each a phase that is followed to its exact end.

In one step of the approach the edge stands where the profile meets the surface. In every step of the rebound the edge
runs over the ground of one step of the approach, the last that is left; sought is how long it takes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple, Protocol

from lumped.errors import NotReached, TooManySteps
from lumped.numbers import falling_zero
from lumped.progress import step_done
from lumped.result.history import AT_REST, End
from lumped.solvers.mdr.row import (
    Fading,
    Instant,
    Place,
    RowProblem,
    RowStep,
    Springs,
    SpringsInRow,
    Values,
    fadings,
    followed,
    followed_bend,
    left,
    none,
    stretched,
    yielding,
)

# Where the approach turns: to this share of the velocities around it.
TURNED = 1e-13
SHORTEST = 1e-14  # rounding: of the time so far, a step as short fails
AT_END = 1.0 - 1e-12  # rounding: of the end time, from which on it is reached
SECANTS = 60  # work: of a step's mean velocity
# The last correction of the rate; what is left after it is the product of two such.
CONVERGED = 1e-9
GAUSS = (0.5 - 0.5 / math.sqrt(3.0), 0.5 + 0.5 / math.sqrt(3.0))  # Gauss' two points on (0, 1)
# Work: steps tried for the separation; of the step, to which it is found; times it, most to try next.
TRIES, CLOSE, WIDER = 100, 1e-7, 4.0
WHOLE_STEPS = 4  # the finer of two marches needs two more than the coarser to get as far
# Work: shares of a step at which a force is looked at.
SAMPLES = (0.01, 0.03, 0.1, 0.3, 0.6, 0.9, 1.0)
SHORT = 1e-14  # what to try first at least, of the time so far
LEAST = 1e-200  # a step that takes no time, s


class Pace(Protocol):
    """Says how long the next step is to be, and whether a tried one may be taken."""

    def propose(self, now: Instant) -> float:
        """Length of the next step, s."""

    def accepts(self, now: Instant, then: Instant) -> bool:
        """Whether a step from `now` to `then` may be taken; if not, `propose` answers with a shorter one."""


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


def approach(problem: RowProblem, end_time: float, pace: Pace, most: int, at_rest: float = AT_REST) -> Inward:
    """The approach at a `pace`, to where the velocity is zero, or has died away in a fluid; or to `end_time`, s.

    Raises NotReached, TooManySteps after `most` steps.
    """
    row = SpringsInRow(problem)
    touch = Instant(0.0, 0.0, problem.velocity, problem.gravity, 0.0, 0.0)
    slow = at_rest * problem.velocity if problem.is_fluid and problem.gravity == 0.0 else 0.0
    instants, turned = _followed(row, touch, pace, end_time, slow, most)
    rests = not turned and instants[-1].velocity < slow
    return Inward(row, instants, None if turned else End.REST if rests else End.TIME)


def rebound(inward: Inward, end_time: float, doubted: bool = False) -> RowTrack:
    """What follows an approach: until the spring at the axis carries no force, or the edge turns under gravity.

    `doubted`: whether it may turn in a last step that `end_time` cuts.
    """
    if inward.end:
        return track_of(inward, inward.end)
    if inward.instants[-1].acceleration >= 0.0:
        return track_of(inward, End.SECOND_APPROACH)
    return retreat(inward, end_time, doubted)


def track_of(inward: Inward, end: End, outward: Sequence[Instant] = (), beyond: Sequence[Instant] = ()) -> RowTrack:
    """An approach and the rebound that was followed of it, as far as it was, with the energies then."""
    row, last = inward.row, (outward or inward.instants)[-1]
    held = row.springs.held(row.problem.modulus, last.depth, row.even)
    return RowTrack(inward.instants, [*outward], end, 2.0 * row.spent, 2.0 * (row.released + held), [*beyond])


def _followed(
    row: SpringsInRow, start: Instant, pace: Pace, end_time: float, slow: float, most: int
) -> tuple[list[Instant], bool]:
    """Instants of the steps until the turn, `end_time`, or until the velocity has died away below `slow`.

    And whether it is the turn. Raises NotReached, and TooManySteps after `most` of them.
    """
    track = [start]
    for _ in range(most):
        now = track[-1]
        h = min(pace.propose(now), end_time - now.time)
        if h <= SHORTEST * now.time:
            raise NotReached(f"the steps became too short at {now.time:.6g} s")
        step = grown(row, now, h)
        if not pace.accepts(now, step.now):
            continue
        turned = step.now.velocity <= 0.0
        if turned:
            step = _to_turn(row, now, step)
        row.take(step)
        track.append(step.now)
        if turned or step.now.time >= AT_END * end_time or 0.0 < step.now.velocity < slow:
            return track, turned
    raise TooManySteps(f"contact had not ended after {most} steps: accepted: a looser tolerance, an earlier end_time")


def _to_turn(row: SpringsInRow, now: Instant, beyond: RowStep) -> RowStep:
    """The step from an instant, where the striker moves inward, that ends where it turns."""
    tried, velocities = beyond, (now.velocity, beyond.now.velocity)

    def velocity(h: float) -> float:
        nonlocal tried
        tried = grown(row, now, h)
        return tried.now.velocity

    small = TURNED * max(now.velocity, -beyond.now.velocity)
    falling_zero(velocity, 0.0, beyond.now.time - now.time, velocities, close=0.0, small=small)
    return tried


def grown(row: SpringsInRow, now: Instant, h: float) -> RowStep:
    """A step of length h, s, not yet taken. Raises NotReached."""
    step_done()
    modulus = row.problem.modulus
    faded = fadings(modulus, h)
    rate, width, pressed = _rate(row, now, h, faded)
    rest = now.depth + rate * (h - pressed)
    shortly, fresh = fadings(modulus, pressed), none(modulus).kept
    even, own = stretched(modulus, row.even, faded, rate), stretched(modulus, fresh, shortly, rate)
    joined = Springs.one(width, rest, [z - mine for z, mine in zip(even, own, strict=True)])
    springs = row.springs.aged([fade.left for fade in faded]).plus(joined)
    spent = row.springs.spent(modulus, row.even, faded, h, rate)
    spent += Springs.one(width, rest, fresh).spent(modulus, fresh, shortly, pressed, rate)
    velocity, depth, edge = 2.0 * rate - now.velocity, now.depth + h * rate, now.edge + width
    axis = followed(modulus, row.axis, faded, now.velocity, velocity, h)
    kept = _kept(row, now, (velocity, edge, now.edge * rate + width * (depth - rest) / h), axis, faded, h)
    lately = [k - before * fade.left for k, before, fade in zip(kept, row.kept, faded, strict=True)]
    instant = row.instant(now.time + h, depth, velocity, edge, springs, axis, kept)
    place = Place(instant.time, depth, edge, axis, joined, lately)
    return RowStep(instant, springs, even, axis, kept, spent, place=place)


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


def retreat(inward: Inward, end_time: float, doubted: bool) -> RowTrack:
    """From the turn until the springs at the axis leave, the edge does not reach its next place, or `end_time`, s.

    Raises NotReached.
    """
    row, track, paces = inward.row, inward.instants[-1:], [1.0]
    while len(row.places) > 1:
        now = track[-1]
        shrinking = Shrinking(row, now)
        tried = _found(shrinking, _next(row, paces))
        if tried is None or now.time + tried.h > end_time:
            beyond = _beyond(row.copy(), now, paces)
            last = shrinking.attempt(end_time - now.time)
            if tried is None and (last.velocity > 0.0 or (doubted and shrinking.turns_before(end_time))):
                return track_of(inward, End.SECOND_APPROACH, track)
            cut = shrinking.step(last)
            row.take(cut)
            return track_of(inward, End.TIME, [*track, cut.now], beyond)
        track.append(_taken(row, shrinking, tried, paces))
    return track_of(inward, End.SEPARATED, track)


def _taken(row: SpringsInRow, shrinking: Shrinking, tried: Attempt, paces: list[float]) -> Instant:
    """Where a step leads, once it is taken; its time, over what the approach took for this ground, is noted."""
    step = shrinking.step(tried)
    paces.append(tried.h / _inward(row))
    row.take(step)
    return step.now


def _beyond(row: SpringsInRow, now: Instant, paces: list[float]) -> list[Instant]:
    """A few whole steps from an instant on: limits of marches are smooth at these, not within a step."""
    track, paces = [now], list(paces)
    while len(row.places) > 1 and len(track) <= WHOLE_STEPS:
        shrinking = Shrinking(row, track[-1])
        tried = _found(shrinking, _next(row, paces))
        if tried is None:
            break
        track.append(_taken(row, shrinking, tried, paces))
    return track[1:]


def _next(row: SpringsInRow, paces: list[float]) -> float:
    """How long a step will take: as the last three have, over the times that the approach took for their ground."""
    last = paces[-1]
    before = paces[-2] if len(paces) > 1 else last
    once = paces[-3] if len(paces) > 2 else 2.0 * before - last
    return _inward(row) * min(max(3.0 * (last - before) + once, 0.5 * last), 2.0 * last)


def _inward(row: SpringsInRow) -> float:
    """The time which the approach took for the ground over which the edge runs back next."""
    return row.places[-1].time - row.places[-2].time


def _found(shrinking: Shrinking, guess: float) -> Attempt | None:
    """The step after which nothing is left of the force at the next place; None where gravity turns the striker first.

    Raises NotReached.
    """
    low, left, h = 0.0, shrinking.pull, max(guess, SHORT * shrinking.now.time)
    if left <= 0.0:
        return shrinking.attempt(0.0)
    for _ in range(TRIES):
        tried = shrinking.attempt(h)
        if tried.pull <= 0.0:
            return _released(shrinking, low, left, tried)
        if tried.velocity > 0.0:
            return None
        further = h + tried.pull * (h - low) / (left - tried.pull) if tried.pull < left else WIDER * h
        if further - h <= CLOSE * h:
            return tried
        low, left, h = h, tried.pull, min(WIDER * h, further)
    raise NotReached(f"the springs at the edge did not leave after {shrinking.now.time:.6g} s", "another --method")


def _released(shrinking: Shrinking, low: float, at_low: float, beyond: Attempt) -> Attempt:
    """The step after which nothing is left, between a length with something left and a step beyond."""
    tried = beyond

    def left_after(h: float) -> float:
        nonlocal tried
        tried = shrinking.attempt(h)
        return tried.pull

    falling_zero(left_after, low, beyond.h, (at_low, beyond.pull), CLOSE)
    return tried


class Attempt(NamedTuple):
    """A step of length h: its rate, the fadings over it and until the springs leave, what the axis carries after it.

    `pull`: force per length of the spring at the place to which the edge runs.
    """

    h: float
    rate: float
    velocity: float
    faded: list[Fading]
    shortly: list[Fading]
    axis: Values
    pull: float


class Shrinking:
    """Steps of any length from an instant; the springs of that ground are pressed for a share of it."""

    def __init__(self, row: SpringsInRow, now: Instant) -> None:
        modulus, last = row.problem.modulus, row.places[-1]
        self.row, self.now, self.place = row, now, row.places[-2]
        shares = left(modulus, now.time - last.time)
        # what the spring at the place to which the edge runs lacks now to the one at the axis
        since = left(modulus, now.time - self.place.time)
        self.lacking = [kept * share for kept, share in zip(self.place.axis, since, strict=True)]
        self.leaving = last.springs.aged(shares)
        self.kept = [k - own * share for k, own, share in zip(row.kept, last.kept, shares, strict=True)]
        self.staying = row.springs.plus(self.leaving, -1.0)
        ground = (last.depth - self.place.depth) * self.leaving.width
        self.share = (last.depth * self.leaving.width - self.leaving.rest) / ground if ground > 0.0 else 0.0

    @property
    def pull(self) -> float:
        """Force per length, now, of the spring at the place to which the edge runs."""
        lift = self._lift(self.now.depth, self.now.velocity)
        return lift + sum(self.row.axis) - sum(self.lacking)

    def turns_before(self, time: float) -> bool:
        """Whether the force at the next place rises before a time, s: where the edge turns, it meets springs again that
        it has left, and what they carry the row does not know.
        """
        pulls = [self.pull, *(self.attempt(share * (time - self.now.time)).pull for share in SAMPLES)]
        return any(after >= before for before, after in pairwise(pulls))

    def attempt(self, h: float) -> Attempt:
        """A step of this length: m (v1 - v0) = m g h - int F dt with v0 + v1 twice the rate."""
        step_done()
        problem, modulus, now, even = self.row.problem, self.row.problem.modulus, self.now, self.row.even
        h = max(h, LEAST)
        pressed = self.share * h
        faded, shortly = fadings(modulus, h), fadings(modulus, pressed)
        passed = self.staying.impulse(modulus, now.depth, even, faded, h)
        passed += self.leaving.impulse(modulus, now.depth, even, shortly, pressed)
        give = self.staying.width * yielding(modulus, faded, h)
        give += self.leaving.width * yielding(modulus, shortly, pressed)
        rate = (now.velocity + 0.5 * h * problem.gravity - passed / problem.mass) / (1.0 + give / problem.mass)
        velocity = 2.0 * rate - now.velocity
        axis = followed(modulus, self.row.axis, faded, now.velocity, velocity, h)
        pull = self._lift(now.depth + h * rate, velocity)
        for z, lack, fade in zip(axis, self.lacking, faded, strict=True):
            pull += z - lack * fade.left
        return Attempt(h, rate, velocity, faded, shortly, axis, pull)

    def _lift(self, depth: float, velocity: float) -> float:
        """What the spring at the place carries without its branches."""
        modulus = self.row.problem.modulus
        return modulus.equilibrium * (depth - self.place.depth) + modulus.viscosity * velocity

    def step(self, tried: Attempt) -> RowStep:
        """The step which was tried, not yet taken."""
        row, now, (h, rate, velocity, faded, shortly, axis, _) = self.row, self.now, tried
        modulus = row.problem.modulus
        pressed = self.share * h
        spent = self.staying.spent(modulus, row.even, faded, h, rate)
        spent += self.leaving.spent(modulus, row.even, shortly, pressed, rate)
        parted = self.leaving.aged([fade.left for fade in shortly])
        released = parted.held(modulus, now.depth + rate * pressed, stretched(modulus, row.even, shortly, rate))
        springs = self.staying.aged([fade.left for fade in faded])
        even = stretched(modulus, row.even, faded, rate)
        kept = [k * fade.left for k, fade in zip(self.kept, faded, strict=True)]
        instant = row.instant(now.time + h, now.depth + h * rate, velocity, self.place.edge, springs, axis, kept)
        return RowStep(instant, springs, even, axis, kept, spent, released)
