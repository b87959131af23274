"""Several contacts as one result: one history through the flights between them, one account of energy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget.certify import Several
from fe_contact.budget.curve import Curve
from fe_contact.march.flight import UNFOLLOWED
from fe_contact.results.contact_row import Row
from fe_contact.results.told import history, quantities_of
from lumped.result.history import COLUMNS, History
from lumped.result.result import UNITS, Result, unmet

IN_FLIGHT = 65  # rows of a flight


def whole(first: Result, certified: Several) -> Result:
    """The result of all contacts, from that of the first."""
    row, followed, last = Row(certified.row), certified.followed, certified.row[-1]
    shares = {name: row.shares(name) for name in UNITS}
    quantities = row.quantities(shares)
    missed = [unmet(quantities_of(one), first.tolerance) for one in certified.row]
    messages = [f"contact {number}: {message}" for number, message in enumerate(missed, start=1) if message]
    if followed.grounded is not None:
        messages.append(f"contacts followed: {len(missed)} of {first.scene.motion.impacts}; {followed.grounded.value}")
    peak = quantities["peak_force"].value or np.inf
    return replace(
        first,
        converged=not any(missed) and followed.grounded not in UNFOLLOWED,
        separated=last.curve.separated,
        history=_history(row, first.tolerance),
        quantities=quantities,
        contacts=tuple(row.told(number) for number in range(len(missed))),
        error_budget={cause: value / peak for cause, value in shares["peak_force"].items()},
        error_budget_by_quantity=shares,
        energy=last.curve.energy,
        energy_error={name: last.energy_error(name) for name in first.energy_error},
        message="; ".join(messages),
    )


def _history(row: Row, tolerance: float) -> History:
    """Rows of all contacts and of the flights between them, by the clock of the first touch."""
    tables = list[Array]()
    for number, budget in enumerate(row.budgets):
        if number:
            tables.append(_flight(row.budgets[number - 1].curve, budget.curve.strike.touched_at))
        told = history(budget, tolerance)
        table = np.array([getattr(told, name) for name in COLUMNS])
        table[0] += budget.curve.strike.touched_at
        tables.append(table)
    columns = dict(zip(COLUMNS, np.hstack(tables), strict=True))
    for number, budget in enumerate(row.budgets):
        columns["force_error"] += _late(budget.curve, columns["time"], row.late(number))
    return History(**columns)


def _flight(curve: Curve, touch: float) -> Array:
    """Rows between the end of a contact and the touch that follows, s."""
    parted = curve.strike.touched_at + curve.duration
    flown = np.linspace(parted, np.nextafter(touch, 0.0), IN_FLIGHT)[1:] - parted
    velocity = curve.strike.gravity * flown - curve.leaving_speed
    depth = curve.dense.depth[-1] + 0.5 * flown * (velocity - curve.leaving_speed)
    return np.array([parted + flown, depth, velocity, *np.zeros((3, flown.size))])


def _late(curve: Curve, time: Array, late: float) -> Array:
    """What the force at times, s, changes where a contact comes as much earlier or later, N."""
    since, shift = time - curve.strike.touched_at, min(late, curve.duration)
    force = curve.force(since)
    return np.maximum(np.abs(curve.force(since + shift) - force), np.abs(curve.force(since - shift) - force))
