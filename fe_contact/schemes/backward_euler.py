"""Stress and force at the end of the step: order one, kept as the classical contrast."""

from __future__ import annotations

import numpy as np

from fe_contact.assembly.forms import Array

ORDER = 1
SAMPLE = 1.0
LEVER = 1.0


def weights(moduli: Array, ratios: Array) -> tuple[Array, Array]:
    """Each branch's stress at the end of the step: per increment, and of its past."""
    return moduli * -np.expm1(-ratios) / ratios, moduli * np.exp(-ratios)


def equilibrium_share() -> float:
    """Share of the displacement increment that the equilibrium spring feels."""
    return 1.0
