"""The correspondence law's rebound, to its first F = 0.

The last piece is followed over q = -sqrt(T - t), T the time of F = 0: there a force falls to nothing smoothly in
q, even where the depth vanishes with it, and T itself is what is sought.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.errors import NotReached, TooManySteps
from lumped.solvers.hereditary.approach import DEPTH, FORCE, VELOCITY, Approach, follow
from lumped.solvers.hereditary.march import SHORTEST, Settings
from lumped.solvers.hereditary.path import Path
from lumped.solvers.hereditary.problem import Hereditary
from lumped.solvers.hereditary.shutting import Guess, Shut, shut

Array = NDArray[np.float64]
MOST_ATTEMPTS = 300
# The duration is found to this relative change; the first time, with few nodes, this share of the accuracy will do.
CLOSED, NEARLY_CLOSED = 1e-12, 1e-2
# Of the force now, what decelerates in the mean until the end of an elastic contact: 0.37 F t^2 = depth.
MEAN_FORCE = 0.37


@dataclass(frozen=True)
class Closing:
    """The path over r before the last piece (None: there is none) and that piece over q, which ends at `end`.

    Without a last piece the path has reached the end time. `steep`: dF/dy at the end.
    """

    path: Path | None
    last: Path | None
    end: float
    steep: float
    steps: int


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
    hoped: Closing | None = None
    for _ in range(MOST_ATTEMPTS):
        zero = path.fall(FORCE)
        if path.end >= limit and zero is None:
            return Closing(path, None, end_time, 0.0, steps)
        begin = path.end if zero is None else float(path.breaks[-2])
        earlier, state = _before(path, begin), path.state(begin)
        guess, last = _guess(problem, begin, state, settings, zero, hoped), None
        if 0.0 < guess.duration < math.inf:
            last = shut(problem, state, guess, settings, NEARLY_CLOSED * settings.rtol, settings.rtol * largest)
        hoped = _closing(earlier, begin, last, steps) if last else None
        if last and hoped and last.fits and hoped.end <= end_time:
            return hoped
        most = 3.0 * begin**2 or (0.5 * path.end) ** 2  # turned and parted within the very first piece: half of it
        target = min((begin**2 + min(0.5 * guess.duration or most, most)) ** 0.5, limit)
        if target - begin <= SHORTEST * begin:
            raise NotReached(f"the end of contact was lost in rounding at {begin**2 * problem.scales.time:.6g} s")
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
        span, state = (path.end, begin), path.state(path.end)
        more = follow(problem, span, state, begin - path.end, _released, settings, largest, before.path)
        path, steps = path.joined(more.path), more.steps
    state, guess = path.state(begin), Guess.of(problem, before.end - begin**2, over, before.steep, settings)
    last = shut(problem, state, guess, settings, CLOSED, settings.rtol * largest)
    if last is None or not last.fits:
        return None
    return _closing(_before(path, begin), begin, last, steps)


def _guess(
    problem: Hereditary, begin: float, state: Array, settings: Settings, zero: float | None, hoped: Closing | None
) -> Guess:
    """Of the last piece from a place on: as it was hoped for earlier, or until a zero of the force, or by the state."""
    if zero is None and hoped and hoped.last and hoped.end > begin**2:
        return Guess.of(problem, hoped.end - begin**2, hoped.last, hoped.steep, settings)
    duration = _until_flat(problem, state) if zero is None else zero**2 - begin**2
    return Guess(duration, np.full(settings.points, problem.gravity - state[FORCE]))


def _closing(path: Path | None, begin: float, last: Shut, steps: int) -> Closing:
    return Closing(path, last.path, begin**2 + last.duration, last.steep, steps + last.steps)


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
