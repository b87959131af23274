"""One impact of the row of springs: approach, then rebound, each to its exact end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

from lumped.errors import NotReached, TooManySteps
from lumped.spring_row.pace import Pace
from lumped.spring_row.row import Instant, Problem, Row, Trial

LOCATING_STEPS = 60
# In a fluid without gravity the approach may die away without a turn: below this share of the velocity at touch
# the striker counts as at rest.
AT_REST = 1e-7
SHORTEST = 1e-14


class End(Enum):
    """Why a march ended."""

    SEPARATED = "separated"
    TIME = "not separated at end_time"
    REST = "the striker came to rest in a fluid"
    SECOND_APPROACH = "the striker approaches again before it has left, which this law does not follow"


@dataclass(frozen=True)
class Track:
    """The instants of an approach, those of the rebound (it starts with the last of the approach), and the end."""

    approach: list[Instant]
    rebound: list[Instant]
    end: End


def march(problem: Problem, end_time: float, pace: Callable[[Instant], Pace], most: int) -> Track:
    """Follow one impact until separation or `end_time`, s. Raises NotReached, TooManySteps after `most` steps.

    `pace` makes the pace of the phase that starts at an instant. The approach ends where the velocity is zero,
    the rebound where the spring at the axis carries no force.
    """
    row = Row(problem)
    touch = Instant(0.0, 0.0, problem.velocity, problem.gravity, 0.0, 0.0)
    at_rest = AT_REST * problem.velocity if problem.is_fluid and problem.gravity == 0.0 else 0.0

    def dies_away(now: Instant) -> bool:
        return now.velocity < at_rest

    inward, turned = _phase(row.try_growing, row.grow, _velocity, dies_away, touch, pace(touch), end_time, most)
    if not turned:
        return Track(inward, [], End.REST if dies_away(inward[-1]) else End.TIME)
    turn = inward[-1]
    outward, left = _phase(row.try_shrinking, row.shrink, _axis, _returns, turn, pace(turn), end_time, most)
    if left:
        return Track(inward, outward, End.SEPARATED)
    return Track(inward, outward, End.SECOND_APPROACH if _returns(outward[-1]) else End.TIME)


def _velocity(trial: Trial) -> float:
    return trial.now.velocity


def _axis(trial: Trial) -> float:
    return trial.axis


def _returns(now: Instant) -> bool:
    return now.velocity > 0.0


def _phase(
    attempt: Callable[[Instant, float], Trial],
    take: Callable[[Trial], None],
    left: Callable[[Trial], float],
    gives_up: Callable[[Instant], bool],
    start: Instant,
    pace: Pace,
    end_time: float,
    most: int,
) -> tuple[list[Instant], bool]:
    """Steps until `left` of a step has fallen to zero (True), or `gives_up` or `end_time` (False)."""
    track = [start]
    level = start.velocity  # at the turn zero: what the axis carries there is not known yet
    for _ in range(most):
        now = track[-1]
        h = min(pace.propose(now), end_time - now.time)
        if h <= SHORTEST * now.time:
            raise NotReached(f"the steps became too short at {now.time:.6g} s")
        trial = attempt(now, h)
        if not pace.accepts(now, trial.now):
            continue
        over = left(trial) <= 0.0
        if over:
            trial = _located(attempt, left, now, trial, level)
        take(trial)
        track.append(trial.now)
        level = left(trial)
        if over or trial.now.time >= end_time * (1.0 - 1e-12) or gives_up(trial.now):
            return track, over
    raise TooManySteps(f"contact had not ended after {most} steps: ask for a looser tolerance or an earlier end_time")


def _located(
    attempt: Callable[[Instant, float], Trial],
    left: Callable[[Trial], float],
    now: Instant,
    beyond: Trial,
    level: float,
) -> Trial:
    """The step from `now`, where `left` is `level`, that ends where it is zero: secant in a bracket (Illinois)."""
    low, high = 0.0, beyond.now.time - now.time
    miss_high = left(beyond)
    miss_low = level if level > 0.0 else -miss_high
    trial, close, side = beyond, 1e-13 * max(miss_low, -miss_high), 0
    for _ in range(LOCATING_STEPS):
        if -miss_high <= close:
            break
        h = high - miss_high * (high - low) / (miss_high - miss_low)
        trial = attempt(now, h)
        miss = left(trial)
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
    return trial
