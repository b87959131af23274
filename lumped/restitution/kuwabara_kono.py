"""Kuwabara and Kono, Brilliantov and Poschel: F = k (depth^(3/2) + (3/2) A sqrt(depth) depth').

Damped by x = (3/2) A (k/m)^(2/5) v_0^(1/5), m the reduced mass, A in s; e falls with the velocity.
doi 10.1143/JJAP.26.1230, doi 10.1103/PhysRevE.53.5382. No closed form is known: the impact is integrated.
"""

from __future__ import annotations

import math

from lumped.errors import NotReached
from lumped.restitution._sphere_impact import log_restitution
from lumped.restitution.base import Limit, check, check_damping, decay_of, formulas
from lumped.schema.keys import Number

TOO_DAMPED = "; beyond it e is below 1e-6"
LIMITS = {"force": Limit(1e4, TOO_DAMPED), "depth": Limit(25.0, TOO_DAMPED)}
# e = 1 - C1 x + (3/5) C1^2 x^2 - ..., C1 = (4/5) (5/4)^(3/5) B(3/5, 3/2); doi 10.1103/PhysRevE.60.4465.
C1: float = 0.8 * 1.25**0.6 * math.gamma(0.6) * math.gamma(1.5) / math.gamma(2.1)
SERIES = Number(7.0 / 12.0, 1.0)
SHORT = ", above the minimum of the series of second order"
# e falls as x^-DECAY when x is large.
DECAY = {"force": 5.0 / 3.0, "depth": 5.0}
ITERATIONS = 30
LAST_STEP = 1e-10


def restitution(damping: float, exit: str = "force") -> float:
    """e at x, to rounding. Raises BadInput."""
    x = check_damping(damping, exit, LIMITS)
    return math.exp(-log_restitution(x, exit)) if x else 1.0


def damping(e: float, exit: str = "force") -> float:
    """The x which meets e, by secants. Raises BadInput, NotReached.

    With p the power of the decay, -ln e is nearly linear in X = p ln(1 + C1 x/p), and equals it to first order.
    """
    decay = decay_of(e, exit)
    power = DECAY[exit]
    last, last_decay, guess = 0.0, 0.0, decay
    for _ in range(ITERATIONS):
        x = power / C1 * math.expm1(guess / power)
        if abs(guess - last) <= LAST_STEP * guess:
            return x
        found = log_restitution(x, exit)
        step = (decay - found) * (guess - last) / (found - last_decay)
        last, last_decay, guess = guess, found, guess + step
    raise NotReached(f"no damping met e = {e:g} in {ITERATIONS} impacts")


def series(e: float) -> float:
    """x of 1 - C1 x + (3/5) C1^2 x^2 = e, from e = 7/12 on; raises BadInput below, where there is none."""
    check("e", e, SERIES, SHORT)
    return 2.0 * (1.0 - e) / (C1 * (1.0 + math.sqrt(max(1.0 - 2.4 * (1.0 - e), 0.0))))


published = formulas(series=series)
