"""The rebound: in every step the edge runs over the ground of one step of the approach; sought is how long it takes."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from lumped.ending import End
from lumped.errors import NotReached
from lumped.spring_row.row import Instant, Row
from lumped.spring_row.shrinking import Shrinking

TRIES, CLOSE, WIDER, BEYOND = 100, 1e-9, 4.0, 1.2
# What to try first at least, of the time so far; and a step that takes no time, s.
SHORT, LEAST = 1e-14, 1e-200


class Bracket(NamedTuple):
    """A length, s, after which something is left of what falls with it, and one after which less than nothing is."""

    low: float
    left: float
    high: float
    missing: float


def retreat(row: Row, start: Instant, end_time: float) -> tuple[list[Instant], End]:
    """The instants from the turn until the springs at the axis leave, gravity turns the striker, or `end_time`, s.

    Raises NotReached.
    """
    track, guess = [start], start.time - row.places[-2].time
    while len(row.places) > 1:
        now = track[-1]
        shrinking = Shrinking(row, now)
        h, end = _length(shrinking, guess)
        if now.time + h > end_time:
            h, end = end_time - now.time, End.TIME
        step = shrinking.step(max(h, LEAST))
        row.take(step)
        track.append(step.now)
        if end is not End.SEPARATED:
            return track, end
        before = now.time - track[-3].time if len(track) > 2 else h
        guess = h * min(max(h / before, 0.5), 2.0) if before > 0.0 else h
    return track, End.SEPARATED


def _length(shrinking: Shrinking, guess: float) -> tuple[float, End]:
    """After how long nothing is left of the force at the next place; or gravity turns the striker before."""
    low, left, h = 0.0, shrinking.pull(0.0), max(guess, SHORT * shrinking.now.time)
    if left <= 0.0:
        return 0.0, End.SEPARATED
    for _ in range(TRIES):
        pull = shrinking.pull(h)
        if pull <= 0.0:
            return _zero(shrinking.pull, Bracket(low, left, h, pull)), End.SEPARATED
        speed = -shrinking.velocity(h)
        if speed < 0.0:
            still = Bracket(0.0, -shrinking.now.velocity or -speed, h, speed)
            return _zero(lambda length: -shrinking.velocity(length), still), End.SECOND_APPROACH
        further = h + BEYOND * pull * (h - low) / (left - pull) if pull < left else WIDER * h
        low, left, h = h, pull, min(WIDER * h, further)
    raise NotReached(f"the springs at the edge did not leave after {shrinking.now.time:.6g} s")


def _zero(left: Callable[[float], float], bracket: Bracket) -> float:
    """The length with nothing left: false position, Illinois."""
    low, at_low, high, at_high = bracket
    side, h = 0, high
    for _ in range(TRIES):
        before, h = h, high - at_high * (high - low) / (at_high - at_low)
        if abs(h - before) <= CLOSE * high:
            break
        found = left(h)
        if found > 0.0:
            low, at_low, at_high, side = h, found, at_high * (0.5 if side == 1 else 1.0), 1
        else:
            high, at_high, at_low, side = h, found, at_low * (0.5 if side == -1 else 1.0), -1
    return h
