"""The rebound: in every step the edge runs over the ground of one step of the approach; sought is how long it takes.

One step of the rebound: the edge runs over the ground of the last step of the approach that is left.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from lumped.errors import NotReached
from lumped.result.history import End
from lumped.solvers.mdr.memory import Fading, fadings
from lumped.solvers.mdr.row import Instant, RowStep, SpringsInRow, Values, followed, left, stretched, yielding

TRIES, CLOSE, WIDER = 100, 1e-7, 4.0
WHOLE_STEPS = 4  # the finer of two marches needs two more than the coarser to get as far
# What to try first at least, of the time so far.
SHORT = 1e-14
# A step that takes no time, s.
LEAST = 1e-200


class Retreat(NamedTuple):
    """The row when the rebound ends, its instants from the turn on, how it ended; whole steps past an end by time."""

    row: SpringsInRow
    instants: list[Instant]
    end: End
    beyond: list[Instant]


def retreat(row: SpringsInRow, start: Instant, end_time: float) -> Retreat:
    """From the turn until the springs at the axis leave, gravity turns the striker, or `end_time`, s.

    Raises NotReached.
    """
    track, paces = [start], [1.0]
    while len(row.places) > 1:
        now = track[-1]
        shrinking = Shrinking(row, now)
        tried, end = _found(shrinking, _next(row, paces))
        if now.time + tried.h > end_time:
            beyond = _beyond(row.copy(), now, paces)
            cut = shrinking.step(shrinking.attempt(end_time - now.time))
            row.take(cut)
            return Retreat(row, [*track, cut.now], End.TIME, beyond)
        step = shrinking.step(tried)
        paces.append(tried.h / _inward(row))
        row.take(step)
        track.append(step.now)
        if end is not End.SEPARATED:
            return Retreat(row, track, end, [])
    return Retreat(row, track, End.SEPARATED, [])


def _beyond(row: SpringsInRow, now: Instant, paces: list[float]) -> list[Instant]:
    """A few whole steps from an instant on: limits of marches are smooth at these, not within a step."""
    track, paces = [now], list(paces)
    while len(row.places) > 1 and len(track) <= WHOLE_STEPS:
        shrinking = Shrinking(row, track[-1])
        tried, end = _found(shrinking, _next(row, paces))
        if end is not End.SEPARATED:
            break
        step = shrinking.step(tried)
        paces.append(tried.h / _inward(row))
        row.take(step)
        track.append(step.now)
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


def _found(shrinking: Shrinking, guess: float) -> tuple[Attempt, End]:
    """The step after which nothing is left of the force at the next place; or after which gravity turns the striker."""
    low, left, h = 0.0, shrinking.pull, max(guess, SHORT * shrinking.now.time)
    if left <= 0.0:
        return shrinking.attempt(0.0), End.SEPARATED
    for _ in range(TRIES):
        tried = shrinking.attempt(h)
        if tried.pull <= 0.0:
            return _zero(shrinking, lambda attempt: attempt.pull, low, left, tried), End.SEPARATED
        if tried.velocity > 0.0:
            fast = -shrinking.now.velocity or tried.velocity
            return _zero(shrinking, lambda attempt: -attempt.velocity, 0.0, fast, tried), End.SECOND_APPROACH
        further = h + tried.pull * (h - low) / (left - tried.pull) if tried.pull < left else WIDER * h
        if further - h <= CLOSE * h:
            return tried, End.SEPARATED
        low, left, h = h, tried.pull, min(WIDER * h, further)
    raise NotReached(f"the springs at the edge did not leave after {shrinking.now.time:.6g} s")


def _zero(
    shrinking: Shrinking, left: Callable[[Attempt], float], low: float, at_low: float, beyond: Attempt
) -> Attempt:
    """The step with nothing left, between a length with something left and a step beyond: false position, Illinois."""
    tried, high, at_high, side = beyond, beyond.h, left(beyond), 0
    for _ in range(TRIES):
        h = high - at_high * (high - low) / (at_high - at_low)
        if abs(h - tried.h) <= CLOSE * high:
            break
        tried = shrinking.attempt(h)
        found = left(tried)
        if found > 0.0:
            low, at_low, at_high, side = h, found, at_high * (0.5 if side == 1 else 1.0), 1
        else:
            high, at_high, at_low, side = h, found, at_low * (0.5 if side == -1 else 1.0), -1
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

    def attempt(self, h: float) -> Attempt:
        """A step of this length: m (v1 - v0) = m g h - int F dt with v0 + v1 twice the rate."""
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
