"""The error budget of an impact: what every cause contributes to the error of every quantity and of the force.

Whatever found them, bars are asked for in one way: see :class:`Solution`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget.curve import Curve
from fe_contact.budget.variation import SAFETY, Softening, Variation
from fe_contact.march.impacts import Grounded
from fe_contact.settings import Numerics
from fe_contact.steppers.steps import March, Work
from lumped.result.history import History, densified
from lumped.result.result import RULED_ABSOLUTE, RULED_RELATIVE, UNITS, Quantity

CAUSES = ("mesh", "penalty", "time_step", "far_field")
SETTING = {"mesh": "elements_per_contact", "penalty": "penalty", "time_step": "steps", "far_field": "far_radius"}
OUTSIDE = ("in", "out")  # terms of the energy account by the motion of the striker alone
LOST = ("contact", "numerical", "residual")  # terms that are zero but for numerical errors
ROWS_SHARE = 0.1  # of the tolerance that a line between two rows may err

Causes = tuple[Variation | Softening | None, ...]  # what one setting changes, None: unknown
Contacts = tuple[Mapping[str, float | None], ...]


@dataclass(frozen=True)
class TotalWork:
    """Counted work of a certified impact: unknowns of the finest mesh; factorisations and back-substitutions
    of all meshes; marches, time steps, contact problems and Newton iterations of all runs.
    """

    degrees_of_freedom: int
    factorizations: int
    solves: int
    marches: int
    steps: int
    contact_problems: int
    iterations: int

    @classmethod
    def of(
        cls, marches: Sequence[Work], degrees_of_freedom: int, factorizations: int, solves: int, flown: int = 0
    ) -> TotalWork:
        """Of all marches together, and of so many steps ``flown`` between contacts."""
        return cls(
            degrees_of_freedom=degrees_of_freedom,
            factorizations=factorizations,
            solves=solves,
            marches=len(marches),
            steps=flown + sum(one.steps for one in marches),
            contact_problems=sum(one.contact_problems for one in marches),
            iterations=sum(one.iterations for one in marches),
        )


class Solution(Protocol):
    """An impact, or several, found with some settings, and its bars: all that a result is made of.

    One contact, unless a kind of them says more.
    """

    if TYPE_CHECKING:  # kinds have it as a field or as a property

        @property
        def numerics(self) -> Numerics:
            """The settings of the finest run."""

    @property
    def separated(self) -> bool:
        """Whether the last contact ended."""

    @property
    def quantities(self) -> Mapping[str, Quantity]:
        """Values with their bars."""

    @property
    def causes(self) -> tuple[str, ...]:
        """What its bars are made of."""
        return CAUSES

    @property
    def parts(self) -> tuple[Mapping[str, Quantity], ...]:
        """The same of every contact that the tolerance rules."""
        return (self.quantities,)

    @property
    def contacts(self) -> Contacts:
        """Every contact, where there may be several; none where a single one is the whole history."""
        return ()

    @property
    def grounded(self) -> Grounded | None:
        """Why there are fewer contacts than were asked for, None: there are not."""
        return None

    @property
    def energy(self) -> Mapping[str, float]:
        """The account at the end, J."""

    @property
    def energy_errors(self) -> Mapping[str, float]:
        """Bars of its terms, J, where they are known."""
        return {}

    @property
    def counted(self) -> Mapping[str, int]:
        """Counted work of all runs."""

    def error(self, name: str, cause: str) -> float:
        """Error of a quantity by one cause, in its unit; infinite where a variation failed."""

    def history(self) -> History:
        """Rows with the force's error band."""


@dataclass(frozen=True)
class Budget(Solution):
    """A contact as a curve with what each setting contributes to its error.

    ``march`` is the finest run behind it, ``work`` that of all runs together.
    """

    curve: Curve
    march: March
    changes: Mapping[str, Causes]
    work: TotalWork
    numerics: Numerics

    @property
    def separated(self) -> bool:
        """Whether the contact ended."""
        return self.curve.separated

    @property
    def causes(self) -> tuple[str, ...]:
        """Those of every impact, then those of its own."""
        return (*CAUSES, *(cause for cause in self.changes if cause not in CAUSES))

    @cached_property
    def quantities(self) -> Mapping[str, Quantity]:
        """Values with their bars; the history's own value is no distance from itself."""
        values = {**self.curve.quantities, "history_l2": 0.0}
        return {
            name: Quantity(values[name], None if values[name] is None else self.total(name), unit)
            for name, unit in UNITS.items()
        }

    @property
    def energy(self) -> Mapping[str, float]:
        """The account at the end, J."""
        return self.curve.energy

    @property
    def energy_errors(self) -> Mapping[str, float]:
        """Bars of its terms, J; what is left over has none."""
        return {name: self.energy_error(name) for name in self.energy if name != "residual"}

    @property
    def counted(self) -> Mapping[str, int]:
        """Counted work of all runs."""
        return asdict(self.work)

    def error(self, name: str, cause: str) -> float:
        """Error of a quantity by one cause, in its unit; infinite where a variation failed."""
        spread = SAFETY * self.curve.peak_spread.get(name, 0.0) if name != "duration" else self.curve.end_spread
        return (spread if cause == "time_step" else 0.0) + sum(_error(change, name) for change in self.changes[cause])

    def total(self, name: str) -> float:
        """Error bar of a quantity, in its unit."""
        return sum(self.error(name, cause) for cause in self.causes)

    def energy_error(self, name: str) -> float:
        """Error bar of a term of the energy account, J; infinite where a variation failed.

        What is lost on the way to the body, or to rounding, may belong to any term within it.
        """
        energy = self.curve.energy
        lost = sum(abs(energy[one]) for one in LOST)
        own = 0.0 if name in OUTSIDE or energy[name] == 0.0 else lost
        error = own + sum(np.inf if one is None else one.energies[name] for row in self.changes.values() for one in row)
        return max(error, self._work_of_weight) if name == "in" else error

    @property
    def _work_of_weight(self) -> float:
        """What the weight does, J, in the time by which the end may come earlier or later."""
        strike, curve = self.curve.strike, self.curve
        if not curve.separated or strike.gravity == 0.0:
            return 0.0
        return strike.mass * strike.gravity * abs(curve.leaving_speed) * self.total("duration")

    def history(self) -> History:
        """Rows dense enough for linear interpolation, with the force's error band."""
        curve = self.curve
        start = np.append(curve.dense_time[:-1:3], curve.dense_time[-1])
        rows = densified(start, curve.force, ROWS_SHARE * self.numerics.tolerance)
        read = curve.read(rows)
        return History(
            time=rows,
            depth=read.depth,
            velocity=curve.velocity(rows, read.impulse),
            force=read.force,
            contact_radius=curve.radius_at(rows),
            force_error=self.force_error(rows),
        )

    def force_error(self, time: Array) -> Array:
        """Half-width of the force's error band, N; the whole of the largest force where a variation failed.

        Before the first step's end it may rise, and after the last step falls to nothing in any way.
        """
        first, last = self.curve.first_step, self.curve.last_step if self.curve.separated else np.inf
        rising = np.where(time < first, self.curve.force(np.array([first])), 0.0)
        fading = np.where(time > last, self.curve.force(np.array([last])), 0.0)
        changes = [change for causes in self.changes.values() for change in causes]
        unknown = np.full_like(time, self.curve.dense_force.max())
        known = [unknown if change is None else change.force(time) for change in changes]
        return np.asarray(np.sum([rising, fading, *known], axis=0))


def _error(change: Variation | Softening | None, name: str) -> float:
    """Error of a quantity by one change; infinite where the variation failed."""
    return np.inf if change is None else change.errors[name]


def shares_of(solution: Solution, cause: str) -> Array:
    """Error by one cause of every quantity that is ruled and known, over what the tolerance allows."""
    known = {name: quantity.value for name, quantity in solution.quantities.items()}
    scales = {name: abs(value) or np.inf for name in RULED_RELATIVE if (value := known[name]) is not None}
    scales |= {name: 1.0 for name in RULED_ABSOLUTE if known[name] is not None}
    return np.array([solution.error(n, cause) / scale for n, scale in scales.items()]) / solution.numerics.tolerance
