"""What errors are measured from where a body has inertia: an exact impact, or a reference that knows its own error."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.results.distance import distance
from fe_contact.studies.tradeoff.point import errors_of, largest_bar, values_of
from lumped.result.result import Result


@dataclass(frozen=True, eq=False)
class Truth:
    """Quantities by name, the force, N, at times (n,), s, linear between ``knots`` (k,), s; ``bar``, how far it is off.

    ``bar`` is the largest of the relative ones, as in :class:`fe_contact.studies.tradeoff.point.Point`.
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
        history = result.history
        off = distance(self.force_at, history.force_at, np.union1d(history.time, self.knots))
        return errors_of(self.values, values_of(result)) | {"history": off}
