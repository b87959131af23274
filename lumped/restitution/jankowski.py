"""Jankowski: F = k depth^(3/2) + 2 xi sqrt(k m sqrt(depth)) depth' in the approach, undamped in the rebound, "(8)".

In x = (4/5) depth^(5/4) the approach is a linear oscillator, v dv/dx = -2 xi v - (5/4) x in units of k and m, of
damping ratio zeta = 2 xi/sqrt(5). The force ends with the depth: both exits are one.
"""

from __future__ import annotations

import math

from lumped.restitution import _oscillator as oscillator
from lumped.restitution.base import Family, check_damping, decay_of, formulas

SQRT5 = math.sqrt(5.0)


def restitution(damping: float, exit: str = "force") -> float:
    """exp(-zeta arccos(zeta)/sqrt(1-zeta^2)), zeta = 2 xi/sqrt(5). Raises BadInput."""
    return math.exp(-oscillator.decay_to_turn(2.0 / SQRT5 * check_damping(damping, exit)))


def damping(e: float, exit: str = "force") -> float:
    """The xi of "(9)" which meets e. Raises BadInput."""
    return 0.5 * SQRT5 * oscillator.zeta_of_decay_to_turn(decay_of(e, exit))


def equation_10(e: float) -> float:
    """sqrt(5) (1-e^2)/(2 pi e), "(10)"."""
    return SQRT5 / math.tau * (1.0 - e) * (1.0 + e) / e


def jankowski_2006(e: float) -> float:
    """(9 sqrt(5)/2) (1-e^2)/(e (e (9 pi - 16) + 16)), doi 10.1002/eqe.537."""
    return 4.5 * SQRT5 * (1.0 - e) * (1.0 + e) / (e * (e * (9.0 * math.pi - 16.0) + 16.0))


MEMBER = Family(restitution, damping, formulas(equation_10=equation_10, jankowski_2006=jankowski_2006))
