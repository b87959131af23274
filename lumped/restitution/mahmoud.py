"""Mahmoud: the Kelvin law, damped by xi in the approach alone: F = k depth in the rebound.

The force ends with the depth: both exits are one.
"""

from __future__ import annotations

import math

from lumped.restitution import _oscillator as oscillator
from lumped.restitution.base import Family, check_damping, decay_of, formulas


def restitution(damping: float, exit: str = "force") -> float:
    """exp(-xi arccos(xi)/sqrt(1-xi^2)): the rebound gives back what the spring holds at the turn. Raises BadInput."""
    return math.exp(-oscillator.decay_to_turn(check_damping(damping, exit)))


def damping(e: float, exit: str = "force") -> float:
    """The xi which meets e. Raises BadInput."""
    return oscillator.zeta_of_decay_to_turn(decay_of(e, exit))


def mahmoud_jankowski(e: float) -> float:
    """(1-e^2)/(e (e (pi-2) + 2)): Mahmoud and Jankowski 2011, Iran. J. Sci. Technol. C 35, 51-62."""
    return (1.0 - e) * (1.0 + e) / (e * (e * (math.pi - 2.0) + 2.0))


MEMBER = Family(restitution, damping, formulas(mahmoud_jankowski=mahmoud_jankowski))
