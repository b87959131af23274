"""Ends of intervals by profile likelihood: how far a quantity may go while all others are chosen anew.

An end is the farthest value of a quantity at which the sum of squares can still stay within its bound (Venzon and
Moolgavkar, doi 10.2307/2347496). On the linearized residuals that has an answer in closed form; it is repeated around
the answer until it stays.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.errors import NotReached
from lumped.numbers import Array

# Quantities, (p,), and residuals, (n,), at a place; or their slopes there, (p, q) and (n, q).
Seen = tuple[Array, Array]
REACHED, LONGEST, MOST_ENDS = 0.02, 0.7, 60  # of the bound; of a step in logarithms; work
LANDED = 0.1  # of the bound: where one step lands as near to it the residuals are straight, and their square is even
# Rounding: differences tell the slopes to about 1e-4; what is told worse than the best by that is not told. Safety: the
# share of a parameter in such a combination that counts.
ALIKE, MIXED = 1e4, 0.03


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

    def end(self, i: int, side: float) -> float | None:
        """The farthest value of quantity i on a side, -1 or 1; None where only an open limit ends it, or nothing.

        The slopes follow the steps (Broyden); where these end on the bound, slopes anew have to say that it is no
        farther, unless one step from the best place led there. Raises NotReached.
        """
        sought, (along, slopes), fresh = self.best, (self.first[0][i], self.first[1]), False
        quantities, residuals = self.seen(sought)
        begin = here = float(quantities[i])
        left = np.linalg.svd(slopes, full_matrices=False)[0]
        residuals = residuals - left @ (left.T @ residuals)  # here is the best place: what slopes say else is rounding
        for steps in range(MOST_ENDS):
            step = _step_inside(residuals, slopes, side * along, self.most, sought, self.limits)
            if step is None:
                return here if self._ends_at(sought, side * along) else None
            share = min(1.0, LONGEST / float(np.abs(step).max()))
            there = np.clip(sought + share * step, *self.limits)
            gone, sought, before, last = there - sought, there, here, residuals
            quantities, residuals = self.seen(there)
            here, excess = float(quantities[i]), float(residuals @ residuals) - self.most
            if steps == 0 and share == 1.0 and abs(excess) <= LANDED * self.bound:
                return begin + (here - begin) * math.sqrt(self.bound / (self.bound + excess))
            small, bounded = abs(here - before) <= REACHED * abs(here - begin), abs(excess) <= REACHED * self.bound
            if small and fresh:
                return here
            if excess < 0.0 and self._opens_at(there, side * along):
                return None
            fresh = small and bounded
            if fresh:
                every, slopes = self.slopes(there)
                along = every[i]
            elif gone.any():
                slopes = slopes + np.outer(residuals - last - slopes @ gone, gone) / float(gone @ gone)
                along = along + (here - before - float(along @ gone)) * gone / float(gone @ gone)
        raise NotReached(f"no end in {MOST_ENDS} steps")

    def _ends_at(self, place: Array, ahead: Array) -> bool:
        """Whether nothing but limits holds a quantity, whose slopes are `ahead`, and none of them is open."""
        low, high = (place == self.limits) & np.array([ahead < 0.0, ahead > 0.0])
        return bool((low | high)[ahead != 0.0].all()) and not self._opens_at(place, ahead)

    def _opens_at(self, place: Array, ahead: Array) -> bool:
        """Whether a limit that only ends the search holds what the quantity depends on."""
        depends = np.abs(ahead) > MIXED * np.abs(ahead).max()
        held = (place == self.limits) & np.array([ahead < 0.0, ahead > 0.0]) & self.opened
        return bool(held[:, depends].any())


def open_side(low: float | None, high: float | None) -> str:
    """Where an interval has no end, "below" or "above"; empty where it has both."""
    return "below" if low is None else "above" if high is None else ""


def forward_slopes(of: Callable[[Array], Array], place: Array, highest: Array, length: float) -> Array:
    """How values (n,) change with a place (q,), (n, q): forward differences, backward at the `highest` place."""
    here, steps = of(place), np.where(place + length <= highest, length, -length)
    return np.array([(of(there) - here) / step for there, step in zip(place + np.diag(steps), steps, strict=True)]).T


def _step_inside(
    residuals: Array, slopes: Array, along: Array, most: float, sought: Array, limits: Array
) -> Array | None:
    """The step to the end, without what stands at a limit and would leave it; None where there is none."""
    held = np.zeros(sought.size, dtype=bool)
    while along[~held].any():
        part = _step_to_end(residuals, slopes[:, ~held], along[~held], most)
        if part is None:
            return None
        step = np.zeros(sought.size)
        step[~held] = part
        leaving = ((sought <= limits[0]) & (step < 0.0)) | ((sought >= limits[1]) & (step > 0.0))
        if not leaving.any():
            return step
        held |= leaving
    return None


def _step_to_end(residuals: Array, slopes: Array, along: Array, most: float) -> Array | None:
    """max g d with |r + J d|^2 <= most: from the least squares on along C g, C = (J^T J)^-1, g the slopes `along`.

    None where J does not tell g d from others.
    """
    left, singular, axes = np.linalg.svd(slopes, full_matrices=False)
    told = singular * ALIKE > singular[0]
    shares = np.abs(axes @ along)
    if shares[~told].max(initial=0.0) > MIXED * float(np.linalg.norm(along)):
        return None
    left, singular, axes = left[:, told], singular[told], axes[told]
    to_least = -axes.T @ ((left.T @ residuals) / singular)
    ahead = axes.T @ ((axes @ along) / singular**2)
    remaining = most - float(np.sum((residuals + slopes @ to_least) ** 2))
    return np.asarray(to_least + math.sqrt(max(remaining, 0.0) / float(ahead @ along)) * ahead)
