"""When a contact with waves ends: read from the last steps in which something presses."""

from __future__ import annotations

import numpy as np

from fe_contact.assembly.forms import Array

READ, STRAIGHT = 5, 3  # last steps asked, by a parabola and by a line
SOONEST = 0.05  # steps after the last one in which something presses


def parting(time: Array, force: Array, exponent: float) -> tuple[float, float] | None:
    """When contact ends, s, and how well that is read, s: a force depth^n falls to zero as (time left)^n.

    Only near its end: where the edge recedes faster than waves run, the last thousandth of the force falls otherwise,
    and under a dashpot almost the whole contact is a faint tail. None where too few steps follow the peak.

    ``time`` (n,), s, equidistant, and ``force`` (n,), N, zero at last; ``exponent`` n.
    """
    last, step = int(np.flatnonzero(force > 0.0)[-1]), float(time[-1] - time[-2])
    late = slice(last + 1 - READ, last + 1)
    if late.start <= force.argmax() or not (force[late] > 0.0).all():
        return None
    x, root = (time[late] - time[last]) / step, force[late] ** (1.0 / exponent)
    slope, start = np.polyfit(x[-STRAIGHT:], root[-STRAIGHT:], 1)
    straight = -float(start / slope)
    ends = [float(zero.real) for zero in np.roots(np.polyfit(x, root, 2)) if zero.imag == 0.0]
    curved = min(ends, key=lambda end: abs(end - straight), default=straight)
    end = min(max(curved, SOONEST), 1.0)
    apart = min(abs(curved - straight) + abs(curved - end), 1.0) if ends else 1.0
    return float(time[last]) + step * end, step * apart
