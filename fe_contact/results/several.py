"""Several contacts as one result: one history through the flights between them, one account of energy.

Certified contacts in a row: bars of every contact and of its touch.

When a contact begins is known no better than how the one before ended: its bar is the larger one of what the varied
settings change of the touch itself and of what the bars before amount to over the flight, 2 v/g long but for the dent.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget.certify import CAUSES, Budget, Several
from fe_contact.budget.change import Change
from fe_contact.budget.curve import Curve
from fe_contact.budget.softening import Softening
from fe_contact.march.flight import UNFOLLOWED
from fe_contact.results.told import history, quantities_of
from fe_contact.steppers.march import Strike
from lumped.result.history import COLUMNS, History
from lumped.result.result import UNITS, Quantity, Result, unmet

IN_FLIGHT = 65  # rows of a flight
TOLD = ("duration", "restitution", "peak_force", "peak_depth")  # of every contact
Shares = Mapping[str, float]  # of an error, by cause


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


@dataclass(frozen=True)
class Row:
    """Budgets of contacts in order."""

    budgets: tuple[Budget, ...]

    @cached_property
    def starts(self) -> tuple[Shares, ...]:
        """Errors of the touches, s."""
        found: list[Shares] = [dict.fromkeys(CAUSES, 0.0)]
        for before, now in pairwise(self.budgets):
            swing = 2.0 * before.curve.strike.velocity / before.curve.strike.gravity
            amount = {c: before.error("duration", c) + swing * before.error("restitution", c) for c in CAUSES}
            moved = _moved(now, lambda strike: strike.touched_at)
            found.append({cause: max(moved[cause], found[-1][cause] + amount[cause]) for cause in CAUSES})
        return tuple(found)

    def shares(self, name: str) -> Shares:
        """Error of a quantity of all contacts by cause, in its unit."""
        errors = [{cause: one.error(name, cause) for cause in CAUSES} for one in self.budgets]
        if name == "impulse":
            return {cause: sum(error[cause] for error in errors) for cause in CAUSES}
        if name == "history_l2":
            return {cause: max(error[cause] for error in errors) for cause in CAUSES}
        number = self._teller(name)
        late = self.starts[number] if name == "peak_time" else dict.fromkeys(CAUSES, 0.0)
        return {cause: late[cause] + errors[number][cause] for cause in CAUSES}

    def quantities(self, shares: Mapping[str, Shares]) -> dict[str, Quantity]:
        """Those of the hardest and the deepest contact, duration and restitution of the first, the whole impulse.

        The history's error is that of its worst contact, each by the clock of its own touch.
        """
        known = [one.curve.quantities for one in self.budgets]
        values = {name: known[self._teller(name)][name] for name in UNITS if name != "history_l2"}
        values["peak_time"] = self._start(self._teller("peak_time")) + (values["peak_time"] or 0.0)
        values["impulse"] = sum(one["impulse"] or 0.0 for one in known)
        values["history_l2"] = 0.0
        bars = {name: sum(shares[name].values()) for name in UNITS}
        return {
            name: Quantity(values[name], None if values[name] is None else bars[name], unit)
            for name, unit in UNITS.items()
        }

    def told(self, number: int) -> dict[str, float | None]:
        """One contact of result.json: as of a lumped law, and the bar of everything."""
        budget, start = self.budgets[number], self._start(number)
        known, late = quantities_of(budget), self.late(number)
        found: dict[str, float | None] = {"start": start, "start_error": late}
        found |= {"velocity": budget.curve.strike.velocity, "velocity_error": self._velocity_error(number)}
        for name in TOLD:
            found |= {name: known[name].value, f"{name}_error": known[name].error}
        when = known["peak_time"]
        return found | {"peak_time": start + (when.value or 0.0), "peak_time_error": late + (when.error or 0.0)}

    def late(self, number: int) -> float:
        """Bar of a touch, s."""
        return sum(self.starts[number].values())

    def _teller(self, name: str) -> int:
        """Which contact tells a quantity."""
        by = {"peak_force": "peak_force", "peak_time": "peak_force", "peak_depth": "peak_depth"}
        if name not in by:
            return 0
        return int(np.argmax([one.curve.quantities[by[name]] or 0.0 for one in self.budgets]))

    def _start(self, number: int) -> float:
        return self.budgets[number].curve.strike.touched_at

    def _velocity_error(self, number: int) -> float:
        """Of the velocity at touch, m/s."""
        if number == 0:
            return 0.0
        before, now = self.budgets[number - 1 : number + 1]
        moved = _moved(now, lambda strike: strike.velocity)
        speed = before.curve.strike.velocity
        return sum(max(moved[cause], speed * before.error("restitution", cause)) for cause in CAUSES)


def _moved(budget: Budget, of: Callable[[Strike], float]) -> Shares:
    """What the varied settings make out in something of the touch, by cause."""
    return {cause: sum(_error(change, of) for change in budget.changes[cause]) for cause in CAUSES}


def _error(change: Change | Softening | None, of: Callable[[Strike], float]) -> float:
    """Of one change; infinite where the variation failed."""
    if change is None:
        return np.inf
    if isinstance(change, Softening):  # of several contacts only where a body that ends has no far field
        return 0.0
    trust = change.factor * max(change.weights.values(), default=1.0)
    return float(trust * abs(of(change.first.strike) - of(change.second.strike)))
