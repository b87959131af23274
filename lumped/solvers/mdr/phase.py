"""One phase of an impact, the approach or the rebound, followed to its exact end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from lumped.errors import NotReached, TooManySteps
from lumped.solvers.mdr.pace import Pace
from lumped.solvers.mdr.row import Instant, Step

LOCATING_STEPS = 60
CLOSE = 1e-13
SHORTEST = 1e-14
AT_END = 1.0 - 1e-12


@dataclass(frozen=True)
class Phase:
    """How to try a step, how to take it, and what is `left` of the phase after it: at zero it is over."""

    attempt: Callable[[Instant, float], Step]
    take: Callable[[Step], None]
    left: Callable[[Step], float]

    def run(
        self, start: Instant, pace: Pace, end_time: float, slow: float, most: int
    ) -> tuple[list[Instant], Step | None]:
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

    def _located(self, now: Instant, beyond: Step, level: float) -> Step:
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
