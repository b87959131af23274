"""Certified contacts in a row: bars of every contact and of its touch.

When a contact begins is known no better than how the one before ended: its bar is the larger one of what the varied
settings change of the touch itself and of what the bars before amount to over the flight, 2 v/g long but for the dent.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from fe_contact.budget.certify import CAUSES, Budget
from fe_contact.budget.change import Change
from fe_contact.budget.softening import Softening
from fe_contact.results.told import quantities_of
from fe_contact.steppers.march import Strike
from lumped.result.result import UNITS, Quantity

TOLD = ("duration", "restitution", "peak_force", "peak_depth")  # of every contact

Shares = Mapping[str, float]  # of an error, by cause


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
