"""The correspondence law's rebound, to its first F = 0.

The last piece is followed over q = -sqrt(T - t), T the time of F = 0: there a force falls to nothing smoothly in
q, even where the depth vanishes with it, and T itself is what is sought.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from lumped.errors import BadInput, NotReached, TooManySteps
from lumped.numbers import Array
from lumped.solvers.hereditary.approach import Approach, follow
from lumped.solvers.hereditary.march import SHORTEST, Settings, tail
from lumped.solvers.hereditary.path import Path
from lumped.solvers.hereditary.pieces import DEPTH, FORCE, VELOCITY, Followed, PieceAsked, to_end
from lumped.solvers.hereditary.problem import Hereditary

MOST_ATTEMPTS = 300  # work: stretches followed until the contact has ended
# The duration is found to this relative change; the first time, with few nodes, this share of the accuracy will do.
CLOSED, NEARLY_CLOSED = 1e-12, 1e-2
# Of the force now, what decelerates in the mean until the end of an elastic contact: 0.37 F t^2 = depth.
MEAN_FORCE = 0.37
TRIES = 12  # work: guesses of the last piece's duration
# Loads as near to each other tell no slope; a relative change of the duration that is noise once it falls no more.
SAME, ROUNDED = 1e-11, 1e-7
# A duration is near that changes by no more than this share.
NEAR = 0.1
LOST = float(np.finfo(float).eps)  # rounding: of the largest force


@dataclass(frozen=True)
class Closing:
    """The path over r before the last piece (None: there is none) and that piece over q, which ends at `end`.

    Without a last piece the path has reached the end time. `steep`: dF/dy at the end; `blur`: by how much the end moves
    with a force as small as is lost in rounding.
    """

    path: Path | None
    last: Path | None
    end: float
    steep: float
    steps: int
    blur: float = 0.0


def close(
    problem: Hereditary, inward: Approach, end_time: float, settings: Settings, before: Closing | None = None
) -> Followed[Closing]:
    """From an approach that has turned to the first F = 0, or to `end_time`. Raises NotReached, TooManySteps.

    `before` is the same found with fewer nodes: its pieces are kept, and it is where Newton starts.
    """
    path, limit = inward.path.until(float(inward.path.breaks[-1])), end_time**0.5
    steps, largest = 0, inward.largest
    if before and before.last:
        known = yield from _again(problem, path, settings, largest, before, before.last)
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
            last = yield from shut(problem, state, guess, settings, NEARLY_CLOSED * settings.rtol, largest)
        hoped = _closing(earlier, begin, last, steps) if last else None
        if last and hoped and last.fits and hoped.end <= end_time:
            return hoped
        most = 3.0 * begin**2 or (0.5 * path.end) ** 2  # turned and parted within the very first piece: half of it
        target = min((begin**2 + min(0.5 * guess.duration or most, most)) ** 0.5, limit)
        if target - begin <= SHORTEST * begin:
            raise NotReached(f"the end of contact was lost in rounding at {begin**2 * problem.scales.time:.6g} s")
        more = yield from follow(problem, (begin, target), state, target - begin, _released, settings, largest)
        steps += more.steps
        path = earlier.joined(more.path) if earlier else more.path
    raise TooManySteps(f"contact had not ended after {MOST_ATTEMPTS} attempts: accepted: an earlier end_time")


def _again(
    problem: Hereditary, path: Path, settings: Settings, largest: float, before: Closing, over: Path
) -> Followed[Closing | None]:
    """The closing in the pieces of one found before, `over` its last piece; None where they will not do."""
    begin, steps = before.path.end if before.path else 0.0, 0
    if path.end < begin:
        span, state = (path.end, begin), path.state(path.end)
        more = yield from follow(problem, span, state, begin - path.end, _released, settings, largest, before.path)
        path, steps = path.joined(more.path), more.steps
    state, guess = path.state(begin), Guess.of(before.end - begin**2, over, before.steep, settings)
    last = yield from shut(problem, state, guess, settings, CLOSED, largest)
    if last is None or not last.fits:
        return None
    return _closing(_before(path, begin), begin, last, steps)


def _guess(
    problem: Hereditary, begin: float, state: Array, settings: Settings, zero: float | None, hoped: Closing | None
) -> Guess:
    """Of the last piece from a place on: as it was hoped for earlier, or until a zero of the force, or by the state."""
    if zero is None and hoped and hoped.last and hoped.end > begin**2:
        return Guess.of(hoped.end - begin**2, hoped.last, hoped.steep, settings)
    return Guess(_until_flat(problem, state) if zero is None else zero**2 - begin**2)


def _closing(path: Path | None, begin: float, last: Shut, steps: int) -> Closing:
    return Closing(path, last.path, begin**2 + last.duration, last.steep, steps + last.steps, last.blur)


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


class Guess(NamedTuple):
    """A duration, how steeply F falls with the load y, 0 where not known, and what path has about such a force, where.

    Without a path the force is taken as it is now.
    """

    duration: float
    steep: float = 0.0
    over: Path | None = None
    places: Array | None = None

    @classmethod
    def of(cls, duration: float, over: Path, steep: float, settings: Settings) -> Guess:
        """From a piece over q that was found, and ends as this one of another duration."""
        return cls(duration, steep, over, -(duration**0.5) * (1.0 - settings.table.points))

    @classmethod
    def within(cls, duration: float, over: Path, steep: float, settings: Settings) -> Guess:
        """From a piece over q of the same motion, and begun at the same time, but followed for another duration."""
        left = float(over.breaks[0]) ** 2 - duration + duration * (1.0 - settings.table.points) ** 2
        return cls(duration, steep, over, -np.sqrt(np.maximum(left, 0.0)))


class Shut(NamedTuple):
    """A last piece over q, its duration, dF/dy at its end, all Newton steps, whether it `fits`: errs as allowed; `blur`
    as of :class:`Closing`.
    """

    path: Path
    duration: float
    steep: float
    steps: int
    fits: bool
    blur: float


def shut(
    problem: Hereditary, state: Array, start: Guess, settings: Settings, close: float, largest: float
) -> Followed[Shut | None]:
    """The piece from a state that ends with F = 0, its duration found to the relative change `close`.

    That ends where the force of a first, longer one falls to zero; from there on, or where it does not, by secants.
    One that will err by more than is allowed of the `largest` force is not sought any closer, and is None where its end
    is not near yet, as it is where Newton's steps fail, and from a depth whose load is lost in rounding.
    """
    load, slope = (float(value[0]) for value in problem.loads(state[:1]))
    if not load:
        return None
    duration, steps, missed = start.duration, 0, math.inf
    power, unit = _power(float(state[DEPTH]), load, slope)
    guess, steep, before = start, start.steep or unit * _mean_modulus(problem, duration), None
    for _ in range(TRIES):
        try:
            piece = yield PieceAsked(problem, settings.table, to_end, 0.0, duration, state, guess.over, guess.places)
        except (BadInput, NotReached):  # depths beyond the load curve, which the motion may never see
            return None
        if piece is None:
            return None
        steps += piece.steps
        path = Path.of([-(duration**0.5), 0.0], [piece.values])
        now, error = _Fallen.of(piece.values[:, -1], power), tail(piece.values[FORCE])
        steep, zero = (now.steep(before) or steep, None) if before else (steep, path.fall(FORCE))
        change = now.lasts(steep, power) if zero is None else -(zero**2)
        longer = min(max(1.0 + change / duration, 0.5), 2.0)
        fits = error * longer**settings.points <= settings.rtol * largest  # a tail falls with the length
        rounded = max(abs(change), missed) <= ROUNDED * duration and abs(change) > 0.5 * missed
        if not fits and abs(change) > NEAR * duration:
            return None
        if abs(change) <= close * duration or rounded or not fits:
            blur = now.blur(steep, power, LOST * largest)
            return Shut(path, duration if fits else longer * duration, steep, steps, fits, blur)
        before, missed = now, abs(change) if before else math.inf
        guess = Guess.within(longer * duration, path, steep, settings)
        duration = guess.duration
    return None


class _Fallen(NamedTuple):
    """Depth, velocity and force after a try, and the load of that depth by its power, in a unit of its own."""

    depth: float
    velocity: float
    force: float
    load: float

    @classmethod
    def of(cls, state: Array, power: float) -> _Fallen:
        """At a state; the load is odd, as it is of the problem."""
        depth, velocity, force = (float(state[field]) for field in (DEPTH, VELOCITY, FORCE))
        return cls(depth, velocity, force, math.copysign(abs(depth) ** power, depth))

    def steep(self, before: _Fallen) -> float:
        """The secant's dF/dy; 0 where it tells none, or one that does not rise."""
        rise = self.load - before.load
        return max((self.force - before.force) / rise, 0.0) if abs(rise) > SAME * abs(self.load) else 0.0

    def lasts(self, steep: float, power: float) -> float:
        """How much longer F > 0 lasts: on a straight line over the load. Infinite where that does not fall."""
        if not self.load:
            return 0.0
        if self.velocity >= 0.0:
            return math.copysign(math.inf, self.force)
        load = self.load - self.force / steep
        return (math.copysign(abs(load) ** (1.0 / power), load) - self.depth) / self.velocity

    def blur(self, steep: float, power: float, lost: float) -> float:
        """By how much a force that is lost moves the end: little where it falls straight, much where it falls flat."""
        load = abs(self.load)
        deeper = (load + lost / steep) ** (1.0 / power) - load ** (1.0 / power)
        return deeper / abs(self.velocity) if self.velocity else math.inf


def _power(depth: float, load: float, slope: float) -> tuple[float, float]:
    """Power and unit of the load y = unit depth^power around a depth; F falls about straight with y, not with depth."""
    power = slope * depth / load
    return power, abs(load) / abs(depth) ** power  # the load is odd, of a surface that is drawn out too


def _mean_modulus(problem: Hereditary, duration: float) -> float:
    """The mean of E over ages up to a duration: F falls by as much with the load, if this falls evenly."""
    modulus, ages = problem.modulus, duration * problem.rates
    mean = modulus.equilibrium - float(problem.stiffnesses @ (np.expm1(-ages) / ages))
    return mean + modulus.viscosity / duration
