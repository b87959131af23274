"""One impact of the row of springs: approach, then rebound."""

from __future__ import annotations

from dataclasses import dataclass

from lumped.result.ending import AT_REST, End
from lumped.solvers.mdr.growing import grown
from lumped.solvers.mdr.pace import Pace
from lumped.solvers.mdr.phase import Phase
from lumped.solvers.mdr.retreat import retreat
from lumped.solvers.mdr.row import Instant, Problem, Row


@dataclass(frozen=True)
class Inward:
    """The row after an approach, its instants, and how the impact ended in it; None: with the turn."""

    row: Row
    instants: list[Instant]
    end: End | None


@dataclass(frozen=True)
class Track:
    """Instants of the approach, and of the rebound, which starts with the last of them; the end; energies there.

    `spent` in dashpots and `held` in springs, pressed or released, J. `beyond`: whole steps past an end by time.
    """

    approach: list[Instant]
    rebound: list[Instant]
    end: End
    spent: float
    held: float
    beyond: list[Instant]


def march(problem: Problem, end_time: float, pace: Pace, most: int, at_rest: float = AT_REST) -> Track:
    """Follow one impact until separation or `end_time`, s.

    `pace` is that of the approach. Raises NotReached, TooManySteps after `most` steps of it.
    """
    return rebound(approach(problem, end_time, pace, most, at_rest), end_time)


def approach(problem: Problem, end_time: float, pace: Pace, most: int, at_rest: float = AT_REST) -> Inward:
    """The approach, to where the velocity is zero, or has died away in a fluid. Raises as `march` does."""
    row = Row(problem)
    touch = Instant(0.0, 0.0, problem.velocity, problem.gravity, 0.0, 0.0)
    slow = at_rest * problem.velocity if problem.is_fluid and problem.gravity == 0.0 else 0.0
    growing = Phase(lambda now, h: grown(row, now, h), row.take, lambda step: step.now.velocity)
    instants, turned = growing.run(touch, pace, end_time, slow, most)
    rests = turned is None and instants[-1].velocity < slow
    return Inward(row, instants, None if turned else End.REST if rests else End.TIME)


def rebound(inward: Inward, end_time: float) -> Track:
    """What follows an approach: until the spring at the axis carries no force, or gravity turns the striker again."""
    row, turn = inward.row, inward.instants[-1]
    if inward.end:
        return _track(inward, [], inward.end)
    if turn.acceleration >= 0.0:
        return _track(inward, [], End.SECOND_APPROACH)
    found = retreat(row, turn, end_time)
    return _track(inward, found.instants, found.end, found.beyond)


def _track(inward: Inward, outward: list[Instant], end: End, beyond: list[Instant] | None = None) -> Track:
    row, last = inward.row, (outward or inward.instants)[-1]
    held = row.springs.held(row.problem.modulus, last.depth, row.even)
    return Track(inward.instants, outward, end, 2.0 * row.spent, 2.0 * (row.released + held), beyond or [])
