"""One step of the internal variables of a relaxation series, exact for a velocity quadratic in time."""

from __future__ import annotations

import math

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


def step(
    modulus: Relaxation, h: float, velocity: float, acceleration: float
) -> tuple[list[float], list[float], list[float]]:
    """What a step of length h does to z_k = moduli_k int exp(-(t-s)/times_k) d depth(s).

    The velocity starts at `velocity` with slope `acceleration`, and the slope changes linearly by some jerk h.
    Returns, for every term, the decay, the increment without that change, and the increment per unit of it.
    """
    decays, increments, sensitivities = [], [], []
    for stiffness, tau in zip(modulus.moduli, modulus.times, strict=True):
        decay, zeroth, first, second = moments(h / tau)
        decays.append(decay)
        increments.append(stiffness * h * (velocity * zeroth + acceleration * h * first))
        sensitivities.append(0.5 * stiffness * h * h * second)
    return decays, increments, sensitivities
