"""The approach, from touch to the turn; the contact radius grows, and every law with memory agrees on it.

It is integrated over r = sqrt(t): depth, load and memories are smooth in r at touch, and not in t.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.ending import AT_REST
from lumped.hereditary.problem import Hereditary
from lumped.hereditary.solve import Path, Settings, follow

Array = NDArray[np.float64]
# A velocity of AT_REST is rest only if the striker would take longer than this share of the time so far to
# stop.
SLOW = 1e-3


@dataclass(frozen=True)
class Approach:
    """Its path over r; the time where it ended; whether the striker turned there, or came to rest."""

    path: Path
    end: float
    turned: bool
    rests: bool

    def state(self, time: Array) -> Array:
        """States at times up to `end`, shape (3 + 2K, n)."""
        return self.path.at(np.sqrt(np.minimum(time, self.end)))


def over_root(problem: Hereditary) -> Callable[[float, Array], Array]:
    """The equations of motion over r = sqrt(t)."""
    return lambda root, state: 2.0 * root * problem.rate(state)


def approach(problem: Hereditary, end_time: float, settings: Settings) -> Approach:
    """Follow the motion to its turn, to rest, or to `end_time`, in units of the problem. Raises NotReached."""
    slow = AT_REST if problem.modulus.relaxed == 0.0 and problem.gravity == 0.0 else 0.0
    span, rate = (0.0, float(np.sqrt(end_time))), over_root(problem)
    path = follow(rate, span, problem.start(), [lambda _, state: float(state[1]) - slow], settings)
    if path.event is None:
        return Approach(path, end_time, turned=False, rests=False)
    if slow:
        force = float(problem.force(path.at(path.end)))
        if slow > SLOW * force * path.end**2:
            return Approach(path, path.end**2, turned=False, rests=True)
        path = follow(rate, span, problem.start(), [lambda _, state: float(state[1])], settings)
    return Approach(path, path.end**2, turned=True, rests=False)
