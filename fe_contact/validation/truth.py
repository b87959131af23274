"""What errors are measured from where a body has inertia: an exact impact, or a reference that knows its own error."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from fe_contact.forms import Array
from fe_contact.validation.point import errors_of, largest_bar, values_of
from lumped.history import History
from lumped.result import Result

GAUSS = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3.0)  # shares of an interval: exact for the square of a line


@dataclass(frozen=True, eq=False)
class Truth:
    """Quantities by name, the force, N, at times (n,), s, linear between ``knots`` (k,), s; ``bar``, how far it is off.

    ``bar`` is the largest of the relative ones, as in :class:`fe_contact.validation.point.Point`.
    """

    values: Mapping[str, float | None]
    knots: Array
    force_at: Callable[[Array], Array]
    bar: float = 0.0

    @classmethod
    def of(cls, result: Result) -> Truth:
        """What a result says, its bars the truth's own."""
        return cls(values_of(result), result.history.time, result.history.force_at, largest_bar(result))

    def errors(self, result: Result) -> dict[str, float]:
        """Of the measured quantities that both define, and of the history."""
        return errors_of(self.values, values_of(result)) | {"history": self._distance(result.history)}

    def _distance(self, history: History) -> float:
        """Norm of the force's error over the norm of the force; forces that jump do so between two rows of one time."""
        knots = np.union1d(history.time, self.knots)
        lengths = np.diff(knots)
        places = knots[:-1, None] + lengths[:, None] * GAUSS
        known = self.force_at(places)
        off = np.sum(lengths[:, None] * (history.force_at(places) - known) ** 2)
        return float(np.sqrt(off / np.sum(lengths[:, None] * known**2)))
