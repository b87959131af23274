"""Ends of intervals by profile likelihood: how far a quantity may go while all others are chosen anew.

An end is the farthest value of a quantity at which the sum of squares can still stay within its bound (Venzon and
Moolgavkar, doi 10.2307/2347496). On the linearized residuals that has an answer in closed form. A walk goes there, no
farther at once than the slopes hold, and comes back within the bound along a constant value where a step has left it:
so it follows a valley that bends, and stays in it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lumped.errors import BadInput, NotReached
from lumped.numbers import Array

# Quantities, (p,), and residuals, (n,), at a place; or their slopes there, (p, q) and (n, q).
Seen = tuple[Array, Array]
REACHED, LONGEST, MOST_ENDS = 0.02, 0.7, 60  # of the bound; of the first step in logarithms; work
LANDED = 0.1  # of the bound: where one step lands as near to it the residuals are straight, and their square is even
# Work: steps back within the bound. Safety: by how much a step may be longer than one that held, or shorter than one
# that did not; how far at most, where the residuals tell nothing; and the share of what slopes promise that holds.
MOST_BACK, LONGER, SHORTER, FARTHEST, HELD = 30, 2.0, 0.3, 3.0, 0.1
# Rounding: differences tell the slopes to about 1e-4; what is told worse than the best by that is not told. Safety: the
# share of a parameter in such a combination that counts.
ALIKE, MIXED = 1e4, 0.03


@dataclass(frozen=True, eq=False)
class Spot:
    """A place, (q,), the quantities, (p,), and residuals, (n,), there; their slopes, (p, q) and (n, q), or nearly."""

    place: Array
    values: Array
    residuals: Array
    along: Array
    slopes: Array

    @cached_property
    def squares(self) -> float:
        """The sum of squares."""
        return float(self.residuals @ self.residuals)

    def promised(self, step: Array) -> float:
        """By how much the slopes say that a step lessens the sum of squares."""
        return self.squares - float(np.sum((self.residuals + self.slopes @ step) ** 2))

    def moved(self, place: Array, seen: Seen) -> Spot:
        """The spot at another place, whose slopes are these, turned to what was seen on the way (Broyden)."""
        (values, residuals), gone = seen, place - self.place
        share = gone / max(float(gone @ gone), 1e-300)  # rounding: no way at all
        along = self.along + np.outer(values - self.values - self.along @ gone, share)
        slopes = self.slopes + np.outer(residuals - self.residuals - self.slopes @ gone, share)
        return Spot(place, values, residuals, along, slopes)


@dataclass(frozen=True, eq=False)
class WalkEnd:
    """Where a walk has ended, and the quantity's value: None where nothing that the curves tell is beyond.

    `reached`: whether the walk came to its end.
    """

    spot: Spot
    value: float | None
    reached: bool = True


@dataclass(frozen=True, eq=False)
class Ends:
    """Around the `best` place, (q,), whose slopes are `first`, in `limits`, (2, q): up to a sum of squares of `most`.

    That is the least one and the `bound` above it. `opened`, (2, q): which limits only end the search.
    """

    seen: Callable[[Array], Seen]
    slopes: Callable[[Array], Seen]
    best: Array
    first: Seen
    limits: Array
    opened: NDArray[np.bool_]
    most: float
    bound: float

    def of(self, which: Sequence[int]) -> dict[int, tuple[WalkEnd, WalkEnd]]:
        """The lowest and the highest end of quantities, by their numbers: one no nearer than any other end lies.

        An end is the quantity's farthest value; there is none where only an open limit holds it, or nothing.
        """
        found = {(i, side): self._end(i, side, self._start) for i in which for side in (-1.0, 1.0)}
        for (i, side), end in found.items():
            far = max((other.spot for other in found.values()), key=lambda spot: side * float(spot.values[i]))
            if end.value is not None and self._beyond(i, side, far, end.spot) > 0.0:
                found[i, side] = self._end(i, side, far)
        return {i: (found[i, -1.0], found[i, 1.0]) for i in which}

    def _beyond(self, i: int, side: float, far: Spot, near: Spot) -> float:
        """How much farther one spot lies than another, less what two walks may differ by."""
        whole = abs(float(near.values[i] - self._start.values[i]))
        return side * float(far.values[i] - near.values[i]) - 2.0 * REACHED * whole

    @cached_property
    def _start(self) -> Spot:
        """The best place: what slopes say of residuals there is rounding."""
        (along, slopes), (values, residuals) = self.first, self.seen(self.best)
        left = np.linalg.svd(slopes, full_matrices=False)[0]
        return Spot(self.best, values, residuals - left @ (left.T @ residuals), along, slopes)

    def _end(self, i: int, side: float, start: Spot) -> WalkEnd:
        """The end of a walk; none where it comes to a place without a law."""
        try:
            return self._walked(i, side, start)
        except (BadInput, NotReached):
            return WalkEnd(start, None, reached=False)

    def _walked(self, i: int, side: float, here: Spot) -> WalkEnd:
        """The end that a walk meets; slopes anew have to say there that it is no farther, unless one step led there."""
        begin, longest, fresh = float(self._start.values[i]), LONGEST, here is self._start
        for _ in range(MOST_ENDS):
            step = _cut(self._ahead(here, side * here.along[i], self.limits), longest)
            whole = REACHED * abs(float(here.values[i]) - begin)
            if abs(float(here.along[i] @ step)) <= whole:
                if fresh:
                    return self._ended(here, i, side, whole)
                here, fresh = self._afresh(here), True
                continue
            straight = self._at(here, step)
            excess = straight.squares - self.most
            if here is self._start and abs(excess) <= LANDED * self.bound and np.abs(step).max() < longest:
                share = math.sqrt(self.bound / (self.bound + excess))
                return WalkEnd(straight, begin + (float(straight.values[i]) - begin) * share)
            there = self._back(straight, i)
            if there.squares > self.most or side * (there.values[i] - here.values[i]) <= 0.0:
                longest = SHORTER * float(np.abs(step).max())
                here, fresh = here if fresh else self._afresh(here), True
                continue
            if self._opens_at(there.place, side * there.along[i]):
                return WalkEnd(there, None)
            fresh = there is not straight
            here, longest = self._afresh(there) if fresh else there, min(LONGER * longest, FARTHEST)
        return WalkEnd(here, None, reached=False)

    def _ended(self, here: Spot, i: int, side: float, whole: float) -> WalkEnd:
        """The end where a walk goes no farther than slopes say; none where it would, but for limits of the search."""
        ahead = side * here.along[i]
        wide = np.where(self.opened & (np.abs(here.place - self.limits) <= whole), [[-np.inf], [np.inf]], self.limits)
        inside, beyond = (float(ahead @ self._ahead(here, ahead, limits)) for limits in (self.limits, wide))
        return WalkEnd(here, float(here.values[i]) + side * min(inside, whole) if beyond <= inside + whole else None)

    def _at(self, here: Spot, step: Array) -> Spot:
        """A step from a spot, inside the limits. Raises what sees a place."""
        place = np.clip(here.place + step, *self.limits)
        return here.moved(place, self.seen(place))

    def _afresh(self, spot: Spot) -> Spot:
        """The spot with the slopes of its own place."""
        along, slopes = self.slopes(spot.place)
        return replace(spot, along=along, slopes=slopes)

    def _ahead(self, here: Spot, along: Array, limits: Array) -> Array:
        """The step to the end as the slopes have it, inside limits."""
        return _inside(lambda free: _step_to_end(*self._damped(here, free), along[free], self.most), here, limits)

    def _back(self, spot: Spot, i: int) -> Spot:
        """Within the bound again, or where the sum of squares is least, with the value that quantity i has."""
        value, longest, fresh = float(spot.values[i]), LONGEST, False
        for _ in range(MOST_BACK):
            if spot.squares <= self.most:
                break
            step = _cut(self._sideways(spot, i, value), longest)
            promised = spot.promised(step)
            told = promised > REACHED * self.bound
            tried = self._at(spot, step) if told else spot
            if spot.squares - tried.squares > HELD * promised:
                spot, fresh, longest = tried, False, min(LONGER * longest, FARTHEST)
                continue
            if fresh and not told:
                break
            longest = SHORTER * float(np.abs(step).max()) if told else longest
            spot, fresh = spot if fresh else self._afresh(spot), True
        return spot

    def _sideways(self, spot: Spot, i: int, value: float) -> Array:
        """The step to the least sum of squares at a value of quantity i, as the slopes have it."""
        along, off = spot.along[i], value - float(spot.values[i])
        return _inside(lambda free: _step_aside(*self._damped(spot, free), along[free], off), spot, self.limits)

    def _damped(self, here: Spot, free: NDArray[np.bool_]) -> Seen:
        """Residuals and slopes of what is free; what no residual tells costs the bound where it is moved farthest."""
        size = int(np.count_nonzero(free))
        damper = math.sqrt(self.bound) / FARTHEST * np.eye(size)
        return np.append(here.residuals, np.zeros(size)), np.vstack((here.slopes[:, free], damper))

    def _opens_at(self, place: Array, ahead: Array) -> bool:
        """Whether a limit that only ends the search holds what the quantity depends on."""
        depends = np.abs(ahead) > MIXED * np.abs(ahead).max()
        held = (place == self.limits) & np.array([ahead < 0.0, ahead > 0.0]) & self.opened
        return bool(held[:, depends].any())


def student(freedom: int, level: float) -> float:
    """Student's t of the two-sided confidence of a level."""
    from scipy.special import stdtrit

    return float(stdtrit(freedom, 0.5 + 0.5 * level))


def open_side(low: float | None, high: float | None) -> str:
    """Where an interval has no end, "below" or "above"; empty where it has both."""
    return "below" if low is None else "above" if high is None else ""


def forward_slopes(of: Callable[[Array], Array], place: Array, highest: Array, length: float) -> Array:
    """How values (n,) change with a place (q,), (n, q): forward differences, backward at the `highest` place."""
    here, steps = of(place), np.where(place + length <= highest, length, -length)
    return np.array([(of(there) - here) / step for there, step in zip(place + np.diag(steps), steps, strict=True)]).T


def _cut(step: Array, longest: float) -> Array:
    """A step no longer than that in any coordinate."""
    return step * min(1.0, longest / max(float(np.abs(step).max()), longest))


def _inside(step_of: Callable[[NDArray[np.bool_]], Array], here: Spot, limits: Array) -> Array:
    """A step of what is free: of all but what stands at a limit and would leave it."""
    free, step = np.ones(here.place.size, dtype=bool), np.zeros(here.place.size)
    while free.any():
        step = np.zeros(free.size)
        step[free] = step_of(free)
        leaving = ((here.place <= limits[0]) & (step < 0.0)) | ((here.place >= limits[1]) & (step > 0.0))
        if not leaving.any():
            return step
        free &= ~leaving
    return np.zeros(free.size)


def _step_to_end(residuals: Array, slopes: Array, along: Array, most: float) -> Array:
    """max g d with |r + J d|^2 <= most: from the least squares on along C g, C = (J^T J)^-1, g the slopes `along`."""
    left, singular, axes = np.linalg.svd(slopes, full_matrices=False)
    to_least = -axes.T @ ((left.T @ residuals) / singular)
    ahead = axes.T @ ((axes @ along) / singular**2)
    remaining = most - float(np.sum((residuals + slopes @ to_least) ** 2))
    speed = max(float(ahead @ along), 1e-300)  # rounding: of what does not change the quantity
    return np.asarray(to_least + math.sqrt(max(remaining, 0.0) / speed) * ahead)


def _step_aside(residuals: Array, slopes: Array, along: Array, off: float) -> Array:
    """min |r + J d|^2 with g d = off, g the slopes `along`."""
    _, size, axes = np.linalg.svd(along[np.newaxis])
    first = axes[0] * (off / float(size[0])) if size[0] > 0.0 else np.zeros(along.size)
    others = axes[1:].T if size[0] > 0.0 else np.eye(along.size)
    return np.asarray(first + others @ np.linalg.lstsq(slopes @ others, -residuals - slopes @ first, rcond=None)[0])
