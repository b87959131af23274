"""The correspondence law's rebound, to its first F = 0.

The last piece is followed over q = -sqrt(T - t), T the time of F = 0: there a force falls to nothing smoothly in
q, even where the depth vanishes with it, and T itself is what is sought.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumped.errors import TooManySteps
from lumped.hereditary.approach import DEPTH, FORCE, VELOCITY, Approach, follow
from lumped.hereditary.march import Piece, Settings, tail
from lumped.hereditary.motion import Motion
from lumped.hereditary.path import Path
from lumped.hereditary.problem import Hereditary

Array = NDArray[np.float64]
SECANT_STEPS, MOST_ATTEMPTS = 12, 300
# The duration is found to this relative change; the first time, with few nodes, this share of the accuracy will do.
CLOSED, NEARLY_CLOSED = 1e-12, 1e-2
# A piece that errs by so many times what is allowed will not do, wherever it ends.
HOPELESS = 30.0
# Of the force now, what decelerates in the mean until the end of an elastic contact: 0.37 F t^2 = depth.
MEAN_FORCE = 0.37


@dataclass(frozen=True)
class Closing:
    """The path over r before the last piece (None: there is none) and that piece over q, which ends at `end`.

    Without a last piece the path has reached the end time. `rate`: how fast F over dF/d depth falls with the end.
    """

    path: Path | None
    last: Path | None
    end: float
    rate: float
    steps: int


class Guess(NamedTuple):
    """A duration, the accelerations at the nodes, and how fast F over dF/d depth falls with the duration, or 0."""

    duration: float
    accelerations: Array
    rate: float


class Shut(NamedTuple):
    """A last piece, its duration, how fast F over dF/d depth falls with that, and all Newton steps spent on it."""

    piece: Piece
    duration: float
    rate: float
    steps: int

    def error(self, settings: Settings) -> float:
        """What the last of its polynomials add to the force."""
        return tail(self.piece.values[FORCE], settings.table)

    def path(self, settings: Settings) -> Path:
        """The piece over q."""
        return Path.of([-(self.duration**0.5), 0.0], [self.piece.values], settings.table)


def close(
    problem: Hereditary, inward: Approach, end_time: float, settings: Settings, before: Closing | None = None
) -> Closing:
    """From an approach that has turned to the first F = 0, or to `end_time`. Raises NotReached, TooManySteps.

    `before` is the same found with fewer nodes: its pieces are kept, and it is where Newton starts.
    """
    path, limit = inward.path.until(float(inward.path.breaks[-1])), end_time**0.5
    steps, largest = 0, inward.largest
    if before and before.last:
        known = _again(problem, path, settings, largest, before, before.last)
        if known and known.end <= end_time:
            return known
    for _ in range(MOST_ATTEMPTS):
        zero = path.fall(FORCE)
        if path.end >= limit and zero is None:
            return Closing(path, None, end_time, 0.0, steps)
        begin = path.end if zero is None else float(path.breaks[-2])
        state = path.at(begin)
        duration = _until_flat(problem, state) if zero is None else zero**2 - begin**2
        earlier = _before(path, begin)
        guess = Guess(duration, np.full(settings.points, problem.gravity - state[FORCE]), 0.0)
        hopeful = 0.0 < duration < math.inf
        last = _shut(problem, state, guess, settings, settings.rtol * largest) if hopeful else None
        if last and begin**2 + last.duration <= end_time:
            return Closing(earlier, last.path(settings), begin**2 + last.duration, last.rate, steps + last.steps)
        target = min((begin**2 + min(0.5 * duration, 3.0 * begin**2)) ** 0.5, limit)
        more = follow(problem, (begin, target), state, target - begin, _released, settings, largest)
        steps += more.steps
        path = earlier.joined(more.path) if earlier else more.path
    raise TooManySteps(f"contact had not ended after {MOST_ATTEMPTS} attempts: accepted: an earlier end_time")


def _again(
    problem: Hereditary, path: Path, settings: Settings, largest: float, before: Closing, over: Path
) -> Closing | None:
    """The closing in the pieces of one found before, `over` its last piece; None where they will not do."""
    begin, steps = before.path.end if before.path else 0.0, 0
    if path.end < begin:
        span, state = (path.end, begin), path.at(path.end)
        more = follow(problem, span, state, begin - path.end, _released, settings, largest, before.path)
        path, steps = path.joined(more.path), more.steps
    earlier, nodes = _before(path, begin), -((before.end - begin**2) ** 0.5) * (1.0 - settings.table.nodes)
    guess = Guess(before.end - begin**2, problem.gravity - over.field(FORCE, nodes)[0], before.rate)
    last = _shut(problem, path.at(begin), guess, settings, settings.rtol * largest)
    if last is None:
        return None
    return Closing(earlier, last.path(settings), begin**2 + last.duration, last.rate, steps + last.steps)


def _released(values: Array) -> bool:
    return bool(values[FORCE, 1:].min() <= 0.0)


def _before(path: Path, place: float) -> Path | None:
    """The pieces before a break; None where there are none."""
    count = int(np.searchsorted(path.breaks, place))
    return Path(path.breaks[: count + 1], path.coefficients[:count], place) if count else None


def _until_flat(problem: Hereditary, state: Array) -> float:
    """About the time until the depth vanishes; infinite while the striker moves inward."""
    depth, speed, force = float(state[DEPTH]), -float(state[VELOCITY]), float(state[FORCE]) - problem.gravity
    if speed < 0.0 or force <= 0.0:
        return math.inf
    return 2.0 * depth / (speed + math.sqrt(speed**2 + 4.0 * MEAN_FORCE * force * depth))


def _shut(problem: Hereditary, state: Array, start: Guess, settings: Settings, allowed: float) -> Shut | None:
    """The piece from a state that ends with F = 0: the duration by secants. None where it errs by far too much."""
    duration, a, rate = start
    before, steps = (0.0, 0.0), 0
    for tried in range(SECANT_STEPS):
        piece = Motion.to_end(problem, settings.table, duration).piece(state, a)
        if piece is None:
            return None
        steps += piece.steps
        last = Shut(piece, duration, rate, steps)
        if tried == 1 and last.error(settings) > HOPELESS * allowed:
            return None
        left, elastic = _left(problem, piece.values[:, -1])
        if before[0]:
            rate = (left - before[1]) / (duration - before[0])
        change = -left / (rate or elastic) if (rate or elastic) < 0.0 else 0.0
        if abs(change) <= (CLOSED if start.rate else NEARLY_CLOSED * settings.rtol) * duration:
            return last if last.error(settings) <= allowed else None
        before, a = (duration, left), problem.gravity - piece.values[FORCE, 1:]
        duration = min(max(duration + change, 0.5 * duration), 2.0 * duration)
    return None


def _left(problem: Hereditary, last: Array) -> tuple[float, float]:
    """F over dF/d depth, a depth that falls straight to zero; and how fast it does in an elastic contact."""
    load, slope = (float(value[0]) for value in problem.loads(last[:1]))
    if not slope:
        return 0.0, 0.0
    return float(last[FORCE]) / slope, float(last[VELOCITY]) * load / (slope * float(last[DEPTH]))
