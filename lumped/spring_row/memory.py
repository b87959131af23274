"""One step of the internal variables of a relaxation series, exact for a velocity quadratic in time."""

from __future__ import annotations

import math
from typing import NamedTuple

from lumped.materials import Relaxation

SERIES_BELOW = 0.5
SERIES = tuple(2.0 * (-1.0) ** j / math.factorial(j + 3) for j in range(14))[::-1]


def moments(x: float) -> tuple[float, float, float, float]:
    """exp(-x) and M_p = int_0^1 exp(-x(1-u)) u^p du for p = 0, 1, 2."""
    if x < SERIES_BELOW:
        second = 0.0
        for coefficient in SERIES:
            second = second * x + coefficient
        first = 0.5 * (1.0 - x * second)
        zeroth = 1.0 - x * first
        return 1.0 - x * zeroth, zeroth, first, second
    decay = math.exp(-x)
    zeroth = (1.0 - decay) / x
    first = (1.0 - zeroth) / x
    return decay, zeroth, first, (1.0 - 2.0 * first) / x


class Ageing(NamedTuple):
    """What a step of length h does to z_k = moduli_k int exp(-(t-s)/times_k) d depth(s), for every term k.

    z_k falls by the factor `decays`, then rises by `increments` and, per unit by which the acceleration changes
    over the step, by `changes`.
    """

    decays: list[float]
    increments: list[float]
    changes: list[float]

    def rises(self, change: float) -> list[float]:
        """By how much each z_k rises when the acceleration changes by `change`."""
        return [rise + per * change for rise, per in zip(self.increments, self.changes, strict=True)]


def ageing(modulus: Relaxation, h: float, velocity: float, acceleration: float) -> Ageing:
    """The ageing over a step of length h that starts with `velocity` and `acceleration`, which changes linearly."""
    found = Ageing([], [], [])
    for stiffness, tau in zip(modulus.moduli, modulus.times, strict=True):
        decay, zeroth, first, second = moments(h / tau)
        found.decays.append(decay)
        found.increments.append(stiffness * h * (velocity * zeroth + acceleration * h * first))
        found.changes.append(0.5 * stiffness * h * h * second)
    return found
