"""How well each number is known: intervals by profile likelihood, correlation, and what no curve could tell.

An end of an interval is the farthest value of a parameter at which all others, the touches too, can still be chosen so
that the sum of squares stays within its bound (Venzon and Moolgavkar, doi 10.2307/2347496). On the linearized residuals
that has an answer in closed form; it is repeated around the answer until it stays.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lumped.errors import NotReached
from lumped.identify.histories import Histories
from lumped.identify.keys import FreeKey
from lumped.identify.record import LEVEL, Interval
from lumped.numbers import Array

REACHED, LONGEST, MOST_ENDS = 0.02, 0.7, 60  # of the bound; of a step in logarithms; work
# Rounding: differences tell the slopes to about 1e-4; what is told worse than the best by that is not told. Safety: the
# share of a parameter in such a combination that counts.
ALIKE, MIXED = 1e4, 0.03
# Rounding: slopes by differences depend on each other to about 2e-4 where the force knows one combination alone; an
# exponent beside its factor is told by ten times as much. Safety: the share of a key in a combination that counts.
ONE, MEMBER = 5e-4, 0.1


@dataclass(frozen=True, eq=False)
class Valley:
    """A likely place of all that is sought, (size,), and the limits of the search around it, (2, size)."""

    sought: Array
    limits: Array


def quantile(histories: Histories) -> float:
    """By how much the sum of squares over the noise may grow within an interval: Fisher's F(1, n - p), squared t."""
    from scipy.special import stdtrit

    return float(stdtrit(histories.freedom, 0.5 + 0.5 * LEVEL)) ** 2


@dataclass(frozen=True, eq=False)
class LikelihoodProfile:
    """The profile of the sum of squares over the noise, from a valley on up to `most`, by `bound` above the least."""

    histories: Histories
    valley: Valley
    most: float
    bound: float

    @cached_property
    def slopes(self) -> Array:
        """Of the residuals in the valley, (rows, size)."""
        return self.histories.slopes(self.valley.sought)

    def intervals(self) -> dict[str, Interval]:
        """Of every key, around its value in the valley."""
        return {one.name: self._interval(i, one) for i, one in enumerate(self.histories.keys)}

    def _interval(self, i: int, key: FreeKey) -> Interval:
        ends, unfound = list[float | None](), list[str]()
        for name, side in (("low", -1.0), ("high", 1.0)):
            try:
                end = self.end(i, side)
            except NotReached:
                end = None
                unfound.append(name)
            ends.append(None if end is None else key.at(end))
        low, high = ends
        return Interval(key.at(float(self.valley.sought[i])), low, high, LEVEL, key.kind.unit, tuple(unfound))

    def end(self, i: int, side: float) -> float | None:
        """The farthest place of parameter i on a side, -1 or 1, with a sum of squares below the most; None: none.

        The slopes follow the steps (Broyden); where these end on the bound, slopes anew have to say that it is no
        farther. Raises NotReached.
        """
        best, limits, slopes, fresh = self.valley.sought, self.valley.limits, self.slopes, False
        sought, residuals = best, self.histories.residuals(best)
        if _step_to_end(residuals, slopes, i, side, self.most) is None:
            return None
        for _ in range(MOST_ENDS):
            step = _step_inside(residuals, slopes, i, side, self.most, sought, limits)
            if step is None:
                return None
            there = np.clip(sought + step * min(1.0, LONGEST / float(np.abs(step).max())), *limits)
            gone, before = there - sought, residuals
            sought, residuals = there, self.histories.residuals(there)
            excess = float(residuals @ residuals) - self.most
            if there[i] in limits[:, i] and excess < 0.0:
                return None
            small = abs(gone[i]) <= REACHED * abs(there[i] - best[i])
            if small and fresh:
                return float(there[i] - gone[i])
            fresh = small and abs(excess) <= REACHED * self.bound
            if fresh:
                slopes = self.histories.slopes(there)
            elif gone.any():
                slopes = slopes + np.outer(residuals - before - slopes @ gone, gone) / float(gone @ gone)
        raise NotReached(f"no end in {MOST_ENDS} steps")


def _step_inside(
    residuals: Array, slopes: Array, i: int, side: float, most: float, sought: Array, limits: Array
) -> Array | None:
    """The step to the end, without what stands at a limit and would leave it; None where there is none."""
    held = np.zeros(sought.size, dtype=bool)
    while True:
        moving = np.flatnonzero(~held)
        part = _step_to_end(residuals, slopes[:, moving], int(np.searchsorted(moving, i)), side, most)
        if part is None:
            return None
        step = np.zeros(sought.size)
        step[moving] = part
        leaving = ((sought <= limits[0]) & (step < 0.0)) | ((sought >= limits[1]) & (step > 0.0))
        leaving[i] = False
        if not leaving.any():
            return step
        held |= leaving


def _step_to_end(residuals: Array, slopes: Array, i: int, side: float, most: float) -> Array | None:
    """max side d_i with |r + J d|^2 <= most: from the least squares on along C e_i, C = (J^T J)^-1.

    None where J does not tell d_i from others.
    """
    left, singular, axes = np.linalg.svd(slopes, full_matrices=False)
    told = singular * ALIKE > singular[0]
    if np.abs(axes[~told, i]).max(initial=0.0) > MIXED:
        return None
    left, singular, axes = left[:, told], singular[told], axes[told]
    to_least = -axes.T @ ((left.T @ residuals) / singular)
    along = axes.T @ (axes[:, i] / singular**2)
    remaining = most - float(np.sum((residuals + slopes @ to_least) ** 2))
    return np.asarray(to_least + side * math.sqrt(max(remaining, 0.0) / float(along[i])) * along)


def correlation_of(slopes: Array) -> Array:
    """Of all that is sought, by the linearized residuals, (size, size)."""
    covariance = np.linalg.pinv(slopes.T @ slopes, hermitian=True)
    spread = np.sqrt(np.maximum(np.diag(covariance), 1e-300))  # rounding: of what nothing tells
    return np.asarray(np.clip(covariance / np.outer(spread, spread), -1.0, 1.0))


def untold(histories: Histories, starts: Sequence[Array]) -> tuple[str, ...]:
    """Keys of which no curve of the scene could tell more than a combination, by their names: empty, if there are none.

    That is so where the force's slopes by them depend on each other at every start, at any time of relaxation.
    """
    fewest = tuple(one.name for one in histories.keys)
    for start in starts:
        slopes = histories.slopes(start)
        sizes = np.linalg.norm(slopes, axis=0)
        _, singular, axes = np.linalg.svd(slopes / np.where(sizes > 0.0, sizes, 1.0), full_matrices=False)
        shares = np.linalg.norm(axes[singular < ONE * singular[0]], axis=0)
        names = tuple(one.name for one, share in zip(histories.keys, shares.tolist(), strict=False) if share > MEMBER)
        fewest = min(fewest, names, key=len)
        if not fewest:
            break
    return fewest
