"""The Langevin function L(s) = coth(s) - 1/s and its inverse, to full precision at both ends."""

from __future__ import annotations

import math

from lumped.restitution._newton import newton

# Odd denominators of the continued fraction s/(3 + s^2/(5 + s^2/(7 + ...))); exact to rounding up to s = 1.
FRACTION = range(21, 1, -2)
FRACTION_BELOW = 1.0


def langevin(s: float) -> tuple[float, float]:
    """L(s) and 1 - L(s), s >= 0, neither from the difference of nearly equal numbers."""
    if s < FRACTION_BELOW:
        tail = 0.0
        for odd in FRACTION:
            tail = s * s / (odd + tail)
        rise = tail / s if s else 0.0
        return rise, 1.0 - rise
    fading = math.exp(-2.0 * s)
    rest = 1.0 / s - 2.0 * fading / (1.0 - fading)
    return 1.0 - rest, rest


def langevin_slope(s: float) -> float:
    """L'(s) = 1 - L^2 - 2 L/s, s > 0."""
    rise, rest = langevin(s)
    return rest * (1.0 + rise) - 2.0 * rise / s


def inverse_langevin(rise: float, rest: float) -> float:
    """s with L(s) = rise = 1 - rest, both given so that neither loses digits. Raises NotReached."""
    if rise == 0.0:
        return 0.0

    def value_and_slope(s: float) -> tuple[float, float]:
        found, left = langevin(s)
        return found - rise if s < FRACTION_BELOW else rest - left, langevin_slope(s)

    return newton(value_and_slope, rise * (3.0 - rise * rise) / (rest * (1.0 + rise)))
