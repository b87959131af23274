"""Stress and force at the end of the step: order one, kept as the classical contrast."""

from __future__ import annotations

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.schemes.base import MemoryScheme


def weights(moduli: Array, ratios: Array) -> tuple[Array, Array]:
    """Each branch's stress at the end of the step: per increment, and of its past."""
    return moduli * -np.expm1(-ratios) / ratios, moduli * np.exp(-ratios)


MEMBER = MemoryScheme(order=1, sample=1.0, lever=1.0, weights=weights)
