"""The rebound: in every step the edge runs over the ground of one step of the approach; sought is how long it takes."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from lumped.errors import NotReached
from lumped.result.ending import End
from lumped.solvers.mdr.row import Instant, Row
from lumped.solvers.mdr.shrinking import Attempt, Shrinking

TRIES, CLOSE, WIDER = 100, 1e-7, 4.0
WHOLE_STEPS = 4  # the finer of two marches needs two more than the coarser to get as far
# What to try first at least, of the time so far.
SHORT = 1e-14


class Retreat(NamedTuple):
    """The row when the rebound ends, its instants from the turn on, how it ended; whole steps past an end by time."""

    row: Row
    instants: list[Instant]
    end: End
    beyond: list[Instant]


def retreat(row: Row, start: Instant, end_time: float) -> Retreat:
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


def _beyond(row: Row, now: Instant, paces: list[float]) -> list[Instant]:
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


def _next(row: Row, paces: list[float]) -> float:
    """How long a step will take: as the last three have, over the times that the approach took for their ground."""
    last = paces[-1]
    before = paces[-2] if len(paces) > 1 else last
    once = paces[-3] if len(paces) > 2 else 2.0 * before - last
    return _inward(row) * min(max(3.0 * (last - before) + once, 0.5 * last), 2.0 * last)


def _inward(row: Row) -> float:
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
