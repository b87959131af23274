"""One impact of the row of springs: approach, then rebound."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from lumped.ending import AT_REST, End
from lumped.spring_row.pace import Pace
from lumped.spring_row.phase import Phase
from lumped.spring_row.row import Instant, Problem, Row, Trial


@dataclass(frozen=True)
class Track:
    """Instants of the approach, and of the rebound, which starts with the last of them; and the end."""

    approach: list[Instant]
    rebound: list[Instant]
    end: End


def march(
    problem: Problem,
    end_time: float,
    pace: Callable[[Instant], Pace],
    most: int,
    at_rest: float = AT_REST,
    observe: Callable[[Row, Instant], None] | None = None,
) -> Track:
    """Follow one impact until separation or `end_time`, s. Raises NotReached, TooManySteps after `most`
    steps.

    `pace` makes the pace of the phase that starts at an instant; `observe` sees the row after every step. The
    approach ends where the velocity is zero; the rebound where the spring at the axis carries no force, or
    where gravity makes the striker turn again.
    """
    row = Row(problem)
    touch = Instant(0.0, 0.0, problem.velocity, problem.gravity, 0.0, 0.0)
    slow = at_rest * problem.velocity if problem.is_fluid and problem.gravity == 0.0 else 0.0

    def taken(take: Callable[[Trial], None]) -> Callable[[Trial], None]:
        def both(trial: Trial) -> None:
            take(trial)
            if observe:
                observe(row, trial.now)

        return both

    growing = Phase(row.try_growing, taken(row.grow), lambda trial: trial.now.velocity)
    inward, turned = growing.run(touch, pace(touch), end_time, slow, most)
    turn = inward[-1]
    if turned is None:
        return Track(inward, [], End.REST if turn.velocity < slow else End.TIME)

    if turn.acceleration >= 0.0:
        return Track(inward, [], End.SECOND_APPROACH)

    def pressed(trial: Trial) -> float:
        return trial.axis * turn.edge / turn.force

    def leaving(trial: Trial) -> float:
        return -trial.now.velocity / problem.velocity

    shrinking = Phase(row.try_shrinking, taken(row.shrink), lambda trial: min(pressed(trial), leaving(trial)))
    outward, last = shrinking.run(turn, pace(turn), end_time, 0.0, most)
    if last is None:
        return Track(inward, outward, End.TIME)
    return Track(inward, outward, End.SEPARATED if pressed(last) < leaving(last) else End.SECOND_APPROACH)
