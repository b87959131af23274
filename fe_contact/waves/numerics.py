"""Numerics of a body with inertia: beside the settings of every impact, how its mass stands on the nodes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from fe_contact.settings import Numerics


@dataclass(frozen=True)
class WaveNumerics(Numerics):
    """``scheme`` is one of :mod:`fe_contact.dynamics.schemes`, of spectral radius ``rho`` for what no step follows;
    ``mass`` one of :mod:`fe_contact.dynamics.mass`; ``finer``: times as many elements at the surface as the body has;
    the rest as in Numerics.
    """

    rho: float
    mass: str
    finer: float = 1.0

    def varied(self, **changes: Any) -> WaveNumerics:
        """A copy with some settings changed."""
        return replace(self, **changes)
