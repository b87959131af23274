"""Kelvin: F = k depth + c depth', damped by xi = c/(2 sqrt(k m)), "(5)" to "(7)"; m is the reduced mass."""

from __future__ import annotations

import math

from lumped.restitution import _oscillator as oscillator
from lumped.restitution.base import Family, check_damping, decay_of, formulas


def restitution(damping: float, exit: str = "force") -> float:
    """exp(-2 xi arccos(xi)/sqrt(1-xi^2)) where the force ends, exp(-pi xi/sqrt(1-xi^2)) where the depth does.

    Raises BadInput; at exit "depth" also from critical damping, xi = 1, on.
    """
    return math.exp(-oscillator.decay(check_damping(damping, exit, oscillator.LIMITS), exit))


def damping(e: float, exit: str = "force") -> float:
    """The xi which meets e. Raises BadInput."""
    return oscillator.zeta_of_decay(decay_of(e, exit), exit)


def anagnostopoulos(e: float) -> float:
    """-ln e/sqrt(pi^2 + ln^2 e), "(7)", doi 10.1002/eqe.4290160311: exact where the depth ends."""
    return damping(e, "depth")


MEMBER = Family(restitution, damping, formulas(anagnostopoulos=anagnostopoulos))
