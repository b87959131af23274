"""Contact radius over time, from the radii found in the steps of a march.

The squared radius is smooth in time but for two corners: where the depth is greatest and, in a viscous contact,
where the edge leaves the place up to which the surface was pressed down. A line drawn over a corner would cut it;
a polynomial would swing. So each interval is looked at from both sides, and both must agree which way it bends.
"""

from __future__ import annotations

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget.local_polynomial import LocalPolynomials, peak
from fe_contact.steppers.march import March

INSIDE = np.arange(1, 8)[:, None] / 8  # places put into every interval


def squared_radius(march: March) -> tuple[Array, Array]:
    """Shares of the contact (n,), from touch to the end, and squared radius there, m^2.

    Under a flat end it is the same from the first touch to the last.
    """
    if np.ptp(march.radius) == 0.0:
        return np.array([0.0, 1.0]), np.full(2, march.radius[0] ** 2)
    duration = float(march.time[-1])
    keep = march.radius_time < duration * (1 - 1e-9)
    time, square = march.radius_time[keep], march.radius[keep] ** 2
    last = 0.0 if march.separated else float(march.radius[-1] ** 2)
    turn, _ = peak(march.time, march.depth)
    growing = int(np.searchsorted(time, turn))
    if 3 <= growing < len(time):
        before = slice(growing - 3, growing)
        (at_turn,), _ = LocalPolynomials.through(time[before], square[None, before]).at(np.array([turn]))
        time, square = np.insert(time, growing, turn), np.insert(square, growing, at_turn[0])
    shares = np.concatenate([[0.0], time / duration, [1.0]])
    return seen_from_both_sides(shares, np.concatenate([[0.0], square, [last]]))


def seen_from_both_sides(x: Array, y: Array) -> tuple[Array, Array]:
    """The samples with places in between, on the parabola from the left or the right, whichever bends less.

    Where the two do not lie on the same side of the straight line, the line is kept.
    """
    if len(x) < 6:
        return x, y
    slope = np.diff(y) / np.diff(x)
    bend = np.diff(slope) / (x[2:] - x[:-2])
    start, end = x[2:-3], x[3:-2]
    places = start + INSIDE * (end - start)
    line = y[2:-3] + slope[2:-2] * (places - start)
    left = y[2:-3] + (places - start) * (slope[1:-3] + bend[:-3] * (places - x[1:-4]))
    right = y[3:-2] + (places - end) * (slope[3:-1] + bend[3:] * (places - x[4:-1]))
    above, below = np.minimum(left, right), np.maximum(left, right)
    between = np.where(above > line, above, np.where(below < line, below, line))
    order = np.argsort(np.concatenate([x, places.ravel()]), kind="stable")
    return np.concatenate([x, places.ravel()])[order], np.concatenate([y, between.ravel()])[order]
