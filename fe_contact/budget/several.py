"""Several contacts as one answer: one history through the flights between them, one account of energy.

When a contact begins is known no better than how the one before ended: its bar is the larger one of what the varied
settings change of the touch itself and of what the bars before amount to over the flight, 2 v/g long but for the dent.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, Self

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget.budget import CAUSES, Budget, Causes, Contacts, Solution, TotalWork
from fe_contact.budget.curve import Curve
from fe_contact.budget.variation import Softening, Variation
from fe_contact.march.impacts import Followed, Grounded
from fe_contact.settings import Numerics
from fe_contact.steppers.steps import Strike
from lumped.result.history import COLUMNS, History
from lumped.result.result import UNITS, Quantity

IN_FLIGHT = 65  # rows of a flight
PLACES = 513  # in a contact, where a force is looked for that comes earlier or later
OF_EACH = ("duration", "restitution", "peak_force", "peak_depth")  # of every contact
Shares = Mapping[str, float]  # of an error, by cause
Judged = tuple[Curve, Mapping[str, Causes]]  # a contact, and what the settings change of it


@dataclass(frozen=True)
class Several(Budget):
    """The budget of a first contact, all contacts ``followed`` in the finest run, and those of the ``later`` ones."""

    followed: Followed
    later: tuple[Budget, ...]

    @classmethod
    def judged(
        cls, followed: Followed, known: Iterable[Judged], work: TotalWork, numerics: Numerics, **more: Any
    ) -> Self:
        """From what is ``known`` of every contact; ``more``: what else the whole says."""
        budgets = [
            Budget(curve, contact.march, changes, work, numerics)
            for (curve, changes), contact in zip(known, followed.contacts, strict=True)
        ]
        first, later = budgets[0], tuple(budgets[1:])
        return cls(first.curve, first.march, first.changes, work, numerics, followed, later, **more)

    @property
    def row(self) -> tuple[Budget, ...]:
        """All contacts in order."""
        return (self, *self.later)

    @property
    def parts(self) -> tuple[Mapping[str, Quantity], ...]:
        """The quantities of every contact."""
        return tuple(one.quantities for one in self.row)


@dataclass(frozen=True)
class Row(Solution):
    """All contacts as one: one history through the flights between them, one account of energy."""

    several: Several

    @property
    def budgets(self) -> tuple[Budget, ...]:
        """Those of the contacts, in order."""
        return self.several.row

    @property
    def numerics(self) -> Numerics:
        """The settings of the finest run."""
        return self.several.numerics

    @property
    def separated(self) -> bool:
        """Whether the last contact ended."""
        return self.budgets[-1].separated

    @property
    def parts(self) -> tuple[Mapping[str, Quantity], ...]:
        """The quantities of every contact."""
        return self.several.parts

    @property
    def contacts(self) -> Contacts:
        """As of a lumped law, and the bar of everything."""
        return tuple(self._contact(number) for number in range(len(self.budgets)))

    @property
    def grounded(self) -> Grounded | None:
        """Why there are fewer contacts than were asked for, None: there are not."""
        return self.several.followed.grounded

    @property
    def energy(self) -> Mapping[str, float]:
        """The account at the end of the last contact, J."""
        return self.budgets[-1].energy

    @property
    def energy_errors(self) -> Mapping[str, float]:
        """Bars of its terms, J; what is left over has none."""
        return self.budgets[-1].energy_errors

    @property
    def counted(self) -> Mapping[str, int]:
        """Counted work of all runs."""
        return self.several.counted

    def error(self, name: str, cause: str) -> float:
        """Error of a quantity of all contacts by one cause, in its unit."""
        return self._shares(name)[cause]

    def history(self) -> History:
        """Rows of all contacts and of the flights between them, by the clock of the first touch."""
        tables, pressed = list[Array](), [budget.history() for budget in self.budgets]
        for number, (budget, rows) in enumerate(zip(self.budgets, pressed, strict=True)):
            if number:
                tables.append(_flight(self.budgets[number - 1].curve, budget.curve.strike.touched_at))
            table = np.array([getattr(rows, name) for name in COLUMNS])
            table[0] += budget.curve.strike.touched_at
            tables.append(table)
        columns = dict(zip(COLUMNS, np.hstack(tables), strict=True))
        for number, (budget, rows) in enumerate(zip(self.budgets, pressed, strict=True)):
            since = columns["time"] - budget.curve.strike.touched_at
            columns["force_error"] += _late(budget.curve, rows, since, self.late(number))
        return History(**columns)

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

    def _shares(self, name: str) -> Shares:
        """Error of a quantity of all contacts by cause, in its unit."""
        errors = [{cause: one.error(name, cause) for cause in CAUSES} for one in self.budgets]
        if name == "impulse":
            return {cause: sum(error[cause] for error in errors) for cause in CAUSES}
        if name == "history_l2":
            return {cause: max(error[cause] for error in errors) for cause in CAUSES}
        number = self._teller(name)
        late = self.starts[number] if name == "peak_time" else dict.fromkeys(CAUSES, 0.0)
        return {cause: late[cause] + errors[number][cause] for cause in CAUSES}

    @cached_property
    def quantities(self) -> Mapping[str, Quantity]:
        """Those of the hardest and the deepest contact, duration and restitution of the first, the whole impulse.

        The history's error is that of its worst contact, each by the clock of its own touch.
        """
        known = [one.curve.quantities for one in self.budgets]
        values = {name: known[self._teller(name)][name] for name in UNITS if name != "history_l2"}
        values["peak_time"] = self._start(self._teller("peak_time")) + (values["peak_time"] or 0.0)
        values["impulse"] = sum(one["impulse"] or 0.0 for one in known)
        values["history_l2"] = 0.0
        bars = {name: sum(self._shares(name).values()) for name in UNITS}
        return {
            name: Quantity(values[name], None if values[name] is None else bars[name], unit)
            for name, unit in UNITS.items()
        }

    def _contact(self, number: int) -> dict[str, float | None]:
        """One contact of result.json."""
        budget, start = self.budgets[number], self._start(number)
        known, late = budget.quantities, self.late(number)
        found: dict[str, float | None] = {"start": start, "start_error": late}
        found |= {"velocity": budget.curve.strike.velocity, "velocity_error": self._velocity_error(number)}
        for name in OF_EACH:
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


def _flight(curve: Curve, touch: float) -> Array:
    """Rows between the end of a contact and the touch that follows, s."""
    parted = curve.strike.touched_at + curve.duration
    flown = np.linspace(parted, np.nextafter(touch, 0.0), IN_FLIGHT)[1:] - parted
    velocity = curve.strike.gravity * flown - curve.leaving_speed
    depth = curve.dense.depth[-1] + 0.5 * flown * (velocity - curve.leaving_speed)
    return np.array([parted + flown, depth, velocity, *np.zeros((3, flown.size))])


def _late(curve: Curve, rows: History, since: Array, late: float) -> Array:
    """How much wider, N, the band of a contact's force is at times since its touch, s, for what comes up to as much
    earlier or later; ``rows``: those of the contact, with the band they have by themselves.

    Where a touch is known no better than a contact lasts, both ends of what is possible lie outside of it, and the
    force between them.
    """
    outside, force = 2.0 * curve.duration, curve.force(since)
    early, after = (np.clip(since + shift, -outside, outside) for shift in (-late, late))
    apart = np.maximum(np.abs(curve.force(early) - force), np.abs(curve.force(after) - force))
    places = np.linspace(0.0, curve.duration, PLACES)
    first, behind = np.searchsorted(places, early), np.searchsorted(places, after)
    spans = np.stack([first, behind], axis=1).ravel()
    own = np.interp([*places, outside], rows.time, rows.force_error, right=0.0)
    pressed = np.append(curve.force(places), 0.0)  # one more, for what begins behind the last
    highest = np.maximum.reduceat(pressed + own, spans)[::2] - force
    least = force - np.minimum.reduceat(pressed - own, spans)[::2]
    known = np.interp(since, rows.time, rows.force_error, left=0.0, right=0.0)
    return np.where(first < behind, np.maximum.reduce([apart, highest - known, least - known]), apart)


def _moved(budget: Budget, of: Callable[[Strike], float]) -> Shares:
    """What the varied settings make out in something of the touch, by cause."""
    return {cause: sum(_error(change, of) for change in budget.changes[cause]) for cause in CAUSES}


def _error(change: Variation | Softening | None, of: Callable[[Strike], float]) -> float:
    """Of one change, several contacts with each setting; infinite where the variation failed."""
    if change is None:
        return np.inf
    if isinstance(change, Softening):
        return change.share * abs(of(change.curve.strike))
    trust = change.factor * max(change.weights.values(), default=1.0)
    return float(trust * abs(of(change.first.strike) - of(change.second.strike)))
