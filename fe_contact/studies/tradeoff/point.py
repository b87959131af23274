"""One point of a trade-off: a method with its settings, what it costs and by how much it errs."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from fe_contact.settings import Given
from lumped.result.result import Result

MEASURED = ("peak_force", "duration", "restitution")
REFERENCE = "reference"  # the method of the point that errors are measured from, where it has a bar of its own

T = TypeVar("T")


@dataclass(frozen=True)
class Point:
    """One method with one choice of settings.

    ``errors`` of peak force and duration (relative), restitution (absolute) and history (norm over norm), where
    defined; ``bar`` the largest of the error bars claimed for them; ``cpu``, s; ``work`` counted;
    ``default_for`` the tolerance for which the settings are planned; ``failure`` why there is no answer.
    """

    method: str
    settings: Given
    cpu: float = np.nan
    errors: Mapping[str, float] = field(default_factory=dict)
    bar: float | None = None
    work: Mapping[str, float] = field(default_factory=dict)
    default_for: float | None = None
    failure: str = ""

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


def values_of(result: Result) -> dict[str, float | None]:
    """The quantities without their bars."""
    return {name: quantity.value for name, quantity in result.quantities.items()}


def largest_bar(result: Result) -> float:
    """The largest bar of the measured quantities and of the history."""
    bars = [result.quantities["history_l2"].error or 0.0]
    for name in MEASURED:
        quantity = result.quantities[name]
        if quantity.value is not None and quantity.error is not None:
            bars.append(quantity.error / (1.0 if name == "restitution" else abs(quantity.value)))
    return max(bars)


def timed(run: Callable[[], T], repeats: int) -> tuple[T, float]:
    """What a call gives, and the least processor time it took, s."""
    spent = []
    for _ in range(repeats):
        start = time.process_time()
        found = run()
        spent.append(time.process_time() - start)
    return found, min(spent)
