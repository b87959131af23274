"""What a certified contact tells: its quantities with bars, and the rows of its history."""

from __future__ import annotations

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget.certify import Budget
from lumped.result.history import History, densified
from lumped.result.result import RULED_ABSOLUTE, RULED_RELATIVE, UNITS, Quantity

ROWS_SHARE = 0.1  # of the tolerance that a line between two rows may err


def quantities_of(certified: Budget) -> dict[str, Quantity]:
    """Values with their bars; the history's own value is no distance from itself."""
    values = {**certified.curve.quantities, "history_l2": 0.0}
    return {
        name: Quantity(values[name], None if values[name] is None else certified.total(name), unit)
        for name, unit in UNITS.items()
    }


def shares_of(certified: Budget, cause: str, tolerance: float) -> Array:
    """Error by one cause of every quantity that is ruled and known, over what the tolerance allows."""
    values = certified.curve.quantities
    relative = [
        certified.error(name, cause) / abs(values[name] or np.inf)
        for name in RULED_RELATIVE
        if values[name] is not None
    ]
    absolute = [certified.error(name, cause) for name in RULED_ABSOLUTE if values.get(name, 0.0) is not None]
    return np.array(relative + absolute) / tolerance


def history(certified: Budget, tolerance: float) -> History:
    """Rows dense enough for linear interpolation, with the force's error band."""
    curve = certified.curve
    start = np.append(curve.dense_time[:-1:3], curve.dense_time[-1])
    rows = densified(start, curve.force, ROWS_SHARE * tolerance)
    read = curve.read(rows)
    return History(
        time=rows,
        depth=read.depth,
        velocity=curve.velocity(rows, read.impulse),
        force=read.force,
        contact_radius=curve.radius_at(rows),
        force_error=certified.force_error(rows),
    )
