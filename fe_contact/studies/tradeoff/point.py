"""One point of a trade-off: a method with its settings, what it costs and by how much it errs, and from what truth."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.settings import Given
from lumped.result.result import Result, largest_bar
from lumped.result.score import distance

MEASURED = ("peak_force", "duration", "restitution")
ROUNDING = 1e-12  # of a time
REFERENCE = "reference"  # the method of the point that errors are measured from


@dataclass(frozen=True)
class Point:
    """One method with one choice of settings.

    ``errors`` of peak force and duration (relative), restitution (absolute) and history (norm over norm), where
    defined; ``bar`` the largest of the error bars that a tolerance rules; ``cpu``, s; ``work`` counted;
    ``default_for`` the tolerance for which the settings are planned; ``failure`` why there is no answer;
    ``leaves_out`` what a law does not follow of the scene's model: its bar is its own, not that model's.
    """

    method: str
    settings: Given
    cpu: float = np.nan
    errors: Mapping[str, float] = field(default_factory=dict)
    bar: float | None = None
    work: Mapping[str, float] = field(default_factory=dict)
    default_for: float | None = None
    failure: str = ""
    leaves_out: str = ""

    @property
    def error(self) -> float:
        """The largest error; infinite without an answer."""
        return max(self.errors.values(), default=np.inf)


def errors_of(exact: Mapping[str, float | None], values: Given) -> dict[str, float]:
    """Errors of the measured quantities that both define."""
    found = {}
    for name in MEASURED:
        truth, value = exact[name], values[name]
        if truth is not None and value is not None:
            found[name] = abs(value - truth) / (1.0 if name == "restitution" else abs(truth))
    return found


@dataclass(frozen=True, eq=False)
class Answer:
    """What a run gives: its settings, quantities by name, the largest of their bars, counted work, and the force.

    ``force``, N, at ``time``, s, (n,) each and zero outside; empty where there is no history.
    """

    settings: Given
    values: Mapping[str, float | None]
    bar: float | None
    work: Mapping[str, float]
    time: Array = field(default_factory=lambda: np.zeros(0))
    force: Array = field(default_factory=lambda: np.zeros(0))

    @classmethod
    def of(cls, result: Result, **counted: float) -> Answer:
        """Of an impact, and what else was counted; of several contacts the force of the first, as all others come late
        or early by what those before them err.
        """
        work, history = {**result.work, **counted}, result.history
        first = (result.contacts[0]["duration"] if result.contacts else None) or np.inf
        rows = history.time <= first * (1.0 + ROUNDING)
        values = {name: quantity.value for name, quantity in result.quantities.items()}
        bar = largest_bar(result.quantities)
        return cls(result.numerics, values, bar, work, history.time[rows], history.force[rows])

    def force_at(self, time: Array) -> Array:
        """Force at other times, N: linear between the rows, zero outside them; a force that is cut off ends there."""
        end = self.time[-1]
        times = np.where(np.abs(time - end) <= ROUNDING * end, end, time)
        return np.asarray(np.interp(times, self.time, self.force, left=0.0, right=0.0))


@dataclass(frozen=True, eq=False)
class Truth:
    """What errors are measured from: quantities by name, the force, N, at times (n,), s, linear between ``knots``
    (k,), s; ``bar``, how far it is off, the largest of the relative ones, as in :class:`Point`.
    """

    values: Mapping[str, float | None]
    knots: Array
    force_at: Callable[[Array], Array]
    bar: float = 0.0

    @classmethod
    def of(cls, answer: Answer) -> Truth:
        """What a run says, its bars the truth's own."""
        return cls(answer.values, answer.time, answer.force_at, answer.bar or 0.0)

    def errors(self, answer: Answer, smooth: bool) -> dict[str, float]:
        """Of the measured quantities that both define, and of the history where there is one.

        A ``smooth`` force is compared at its rows, any other between all knots, at which it may jump.
        """
        found = errors_of(self.values, answer.values)
        return found | {"history": self._distance(answer, smooth)} if answer.time.size else found

    def _distance(self, answer: Answer, smooth: bool) -> float:
        """Norm of the force's error over the norm of the force."""
        if not smooth:
            return distance(self.force_at, answer.force_at, np.union1d(answer.time, self.knots))
        times = np.concatenate([answer.time, self.knots[self.knots > answer.time[-1]]])
        known = self.force_at(times)
        squares = np.trapezoid((answer.force_at(times) - known) ** 2, times)
        return float(np.sqrt(squares / np.trapezoid(known**2, times)))
