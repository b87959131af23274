"""Where the time steps lie: fine at first touch and at separation, where the force is a power 3/2 of time."""

from __future__ import annotations

import math
from functools import lru_cache

OVERTIME = 10.0  # past the expected end a step takes so much over the settings' steps of the time since: 1/4 of 40
MOST_OF_REST = 0.75  # largest share of the time left that a step near separation may take


def step_length(done: int, steps: int, peak_share: float) -> float:
    """Length of the next step in units of the expected contact time.

    Both ends of the contact are graded quadratically, so that half-integer powers of the time from touch
    and of the time to separation are resolved; half the steps lie before the peak of the force.

    Parameters
    ----------
    done : steps already taken.
    steps : steps in the expected contact time.
    peak_share : expected time of the peak force over contact time.
    """
    if done < steps:
        return elapsed((done + 1) / steps, peak_share) - elapsed(done / steps, peak_share)
    last = 1 - elapsed((steps - 1) / steps, peak_share)
    return last * growth(steps) ** (done - steps + 1)


def growth(steps: int) -> float:
    """Ratio of successive steps once the expected contact time is over."""
    return 1 + OVERTIME / steps


def share_of_rest(left: float, steps: int) -> float:
    """Share of the time left, itself a share of the contact time, that the next step may take.

    As many steps are left as the grading at the end of a contact would have: the time left falls with their square.
    """
    to_go = max(steps * math.sqrt(left / 3), 1.0)
    return min((2 * to_go - 1) / to_go**2, MOST_OF_REST)


@lru_cache(maxsize=4096)
def elapsed(share: float, peak_share: float) -> float:
    """Time over contact time after a share of the steps; 0 at 0, 1 at 1, ``peak_share`` at 1/2 at most."""
    middle = _inverse_smoothstep(min(peak_share, 0.5))
    growth = 2 * math.log(1 / middle - 1)
    grown = share if growth < 1e-9 else math.expm1(growth * share) / math.expm1(growth)
    return grown * grown * (3 - 2 * grown)


def _inverse_smoothstep(value: float) -> float:
    """w with 3 w^2 - 2 w^3 = value, 0 < value <= 1/2."""
    return 0.5 - math.sin(math.asin(1 - 2 * value) / 3)
