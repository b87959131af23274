"""How hard, how deep and how long an impact is: what the ledger's estimates go by."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from lumped.result.history import History
from lumped.result.result import Quantity


@dataclass(frozen=True)
class Peak:
    """Scales of an impact: N, m, m, s. `duration` may be twice the time of the peak."""

    force: float
    depth: float
    contact_radius: float
    duration: float

    @classmethod
    def of(cls, quantities: Mapping[str, Quantity], history: History) -> Peak:
        """Of an impact; where its contact does not end, the pulse lasts twice as long as to its peak."""
        number = {name: quantity.value or 0.0 for name, quantity in quantities.items()}
        duration = number["duration"] or 2.0 * number["peak_time"]
        return cls(number["peak_force"], number["peak_depth"], float(history.contact_radius.max()), duration)

    @property
    def steepness(self) -> float:
        """depth/a: for a sphere a/R."""
        return self.depth / self.contact_radius if self.contact_radius > 0.0 else 0.0
