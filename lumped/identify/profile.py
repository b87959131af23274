"""How well each number is known: intervals by profile likelihood, correlation, and what no curve could tell.

All others, the touches too, are chosen anew at every value.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lumped.fit.profile import Ends, WalkEnd
from lumped.identify.histories import Histories
from lumped.identify.record import LEVEL, Interval
from lumped.numbers import Array

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
        keys = self.histories.keys
        return {keys[i].name: self._interval(i, *ends) for i, ends in self._ends.of(range(len(keys))).items()}

    def _interval(self, i: int, *ends: WalkEnd) -> Interval:
        key = self.histories.keys[i]
        low, high = (None if end.value is None else key.at(end.value) for end in ends)
        unfound = tuple(name for name, end in zip(("low", "high"), ends, strict=True) if not end.reached)
        return Interval(key.at(float(self.valley.sought[i])), low, high, LEVEL, key.kind.unit, unfound)

    @cached_property
    def _ends(self) -> Ends:
        """What is sought is told itself."""
        own, limits = np.eye(self.valley.sought.size), self.valley.limits
        touches = [(True, True)] * len(self.histories.samples)
        return Ends(
            seen=lambda sought: (sought, self.histories.residuals(sought)),
            slopes=lambda sought: (own, self.histories.slopes(sought)),
            best=self.valley.sought,
            first=(own, self.slopes),
            limits=limits,
            opened=np.array([*(key.opened for key in self.histories.keys), *touches]).T,
            most=self.most,
            bound=self.bound,
        )


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
