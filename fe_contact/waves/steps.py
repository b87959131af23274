"""Lengths of the steps of an impact with waves: short about an early peak of the force, doubled ever again later."""

from __future__ import annotations

import math

from fe_contact.budget.plan import EARLY_PEAK
from fe_contact.settings import Numerics


def graded(numerics: Numerics) -> tuple[float, tuple[float, ...]]:
    """First step, s, and the times, s, from which steps are twice as long as before.

    From a share of the contact on at which a force may well peak there are ``steps`` to the contact time; half that
    time before they are half as long, down to the time of the peak.
    """
    octaves = max(math.ceil(math.log2(EARLY_PEAK / numerics.peak_share)), 0)
    times = [EARLY_PEAK * numerics.contact_time / 2**earlier for earlier in range(octaves)]
    return numerics.contact_time / numerics.steps / 2**octaves, tuple(reversed(times))
