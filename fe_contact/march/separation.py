"""When contact will end, read from the trend of the axis' elastic response."""

from __future__ import annotations

import math
from collections.abc import Sequence


def time_left(times: Sequence[float], responses: Sequence[float], now: float) -> float | None:
    """Time from ``now`` to separation, s; None while the response does not fall.

    The displacement that the pressure would cause elastically at the axis goes to zero linearly as contact
    ends, whatever the profile and the material: the parabola through its last three samples tells when.

    Parameters
    ----------
    times, responses : last three samples, s and any unit, the latest last.
    """
    first, second, third = responses
    to_second, to_first = times[2] - times[1], times[2] - times[0]
    slope = (third - second) / to_second
    if slope >= 0:
        return None
    bend = (slope - (third - first) / to_first) / (to_first - to_second)
    lean = slope + bend * to_second
    straight = -third / slope
    discriminant = lean * lean - 4 * bend * third
    curved = 2 * third / (math.sqrt(discriminant) - lean) if discriminant >= 0 and lean < 0 else straight
    return max(times[2] + min(curved, 2 * straight) - now, 0.0)
