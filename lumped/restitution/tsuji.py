"""Tsuji: F = k depth^(3/2) + alpha sqrt(m k) depth^(1/4) depth', m the reduced mass, doi 10.1016/0032-5910(92)88030-L.

In x = (4/5) depth^(5/4) it is a linear oscillator, v dv/dx = -alpha v - (5/4) x in units of k and m, of damping
ratio zeta = alpha/sqrt(5). The force is -depth^(1/4) v dv/dx: zero force and zero depth of the one are those of the
other, and e is that of the Kelvin law with xi = zeta, at either exit.
"""

from __future__ import annotations

import math

from lumped.restitution import _oscillator as oscillator
from lumped.restitution.base import Family, Limit, check_damping, decay_of, formulas

SQRT5 = math.sqrt(5.0)
LIMITS = oscillator.LIMITS | {"depth": Limit(SQRT5 * oscillator.UNDERDAMPED, oscillator.NEVER_BACK)}
POLYNOMIAL = (1.2728, -4.2783, 11.087, -22.348, 27.467, -18.022, 4.8218)


def restitution(damping: float, exit: str = "force") -> float:
    """That of the Kelvin law with xi = alpha/sqrt(5). Raises BadInput."""
    return math.exp(-oscillator.decay(check_damping(damping, exit, LIMITS) / SQRT5, exit))


def damping(e: float, exit: str = "force") -> float:
    """The alpha which meets e; at exit "depth" sqrt(5) |ln e|/sqrt(pi^2 + ln^2 e). Raises BadInput."""
    return SQRT5 * oscillator.zeta_of_decay(decay_of(e, exit), exit)


def antypov_elliott(e: float) -> float:
    """sqrt(5) |ln e|/sqrt(pi^2 + ln^2 e), doi 10.1209/0295-5075/94/50004: exact where the depth ends."""
    return damping(e, "depth")


def tsuji_polynomial(e: float) -> float:
    """sqrt(2) times the fit of degree 6 to Tsuji's curve, doi 10.1016/j.jcp.2008.10.020.

    The fit counts in the mass of one of two equal spheres; the square root of 2 makes it the reduced mass.
    """
    return math.sqrt(2.0) * sum(coefficient * e**power for power, coefficient in enumerate(POLYNOMIAL))


MEMBER = Family(restitution, damping, formulas(antypov_elliott=antypov_elliott, tsuji_polynomial=tsuji_polynomial))
