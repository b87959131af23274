"""How hard, how deep and how long an impact is: what the ledger's estimates go by."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Peak:
    """Scales of an impact: N, m, m, s. `duration` may be twice the time of the peak."""

    force: float
    depth: float
    contact_radius: float
    duration: float

    @property
    def steepness(self) -> float:
        """depth/a: for a sphere a/R."""
        return self.depth / self.contact_radius if self.contact_radius > 0.0 else 0.0
