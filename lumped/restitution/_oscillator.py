"""The damped linear oscillator x'' + 2 zeta x' + x = 0 that starts at x = 0 with x' = 1.

It turns when arccos(zeta)/sqrt(1-zeta^2) has passed, its force 2 zeta x' + x is zero after twice that time, and x
itself after pi/sqrt(1-zeta^2). Overdamped, arccosh(zeta)/sqrt(zeta^2-1) takes the place of the first, and x never
returns to zero. A decay is -ln of an amplitude, and is zeta times the time in all three cases.
"""

from __future__ import annotations

import math

from lumped.restitution.base import Limit, newton

# The speed at zero x is below 1e-96 at this damping ratio.
UNDERDAMPED = 0.9999
NEVER_BACK = '; from critical damping on the depth never returns to zero: ask for exit = "force"'
LIMITS = {"force": Limit(), "depth": Limit(UNDERDAMPED, NEVER_BACK)}
NEAR_CRITICAL = 1e-8


def decay(zeta: float, exit: str) -> float:
    """-ln of the speed where the force is zero, or the depth x."""
    if exit == "force":
        return 2.0 * decay_to_turn(zeta)
    return math.pi * zeta / math.sqrt((1.0 - zeta) * (1.0 + zeta))


def zeta_of_decay(decay: float, exit: str) -> float:
    """The inverse of `decay`; at exit "depth" that is "(7)". Raises NotReached."""
    if exit == "force":
        return zeta_of_decay_to_turn(0.5 * decay)
    return decay / math.hypot(math.pi, decay)


def decay_to_turn(zeta: float) -> float:
    """-ln of the largest x."""
    return zeta * turning_time(zeta)


def zeta_of_decay_to_turn(decay: float) -> float:
    """The inverse of `decay_to_turn`. Raises NotReached."""
    if decay == 0.0:
        return 0.0

    def value_and_slope(zeta: float) -> tuple[float, float]:
        return decay_to_turn(zeta) - decay, _slope(zeta)

    return newton(value_and_slope, math.sinh(decay))


def turning_time(zeta: float) -> float:
    """arccos(zeta)/sqrt(1-zeta^2), arccosh above 1: falls from pi/2 at zeta = 0 through 1 at zeta = 1."""
    if zeta == 1.0:
        return 1.0
    reach = math.sqrt(abs(1.0 - zeta) * (1.0 + zeta))
    return (math.acos(zeta) if zeta < 1.0 else math.acosh(zeta)) / reach


def _slope(zeta: float) -> float:
    """d decay_to_turn/d zeta = (turning time - zeta)/(1 - zeta^2), 2/3 at zeta = 1."""
    if abs(1.0 - zeta) < NEAR_CRITICAL:
        return 2.0 / 3.0
    return (turning_time(zeta) - zeta) / ((1.0 - zeta) * (1.0 + zeta))
