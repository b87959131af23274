"""Displacement linear, pressure constant over a step: the Petrov-Galerkin method of order two.

Stress and force are averages over the step. The work done on the striker is force times change of depth
exactly, whatever the step; stiff branches (dt >> tau) and pure viscosity keep the second order, which a rule that takes
the stress at the end of the step loses.
"""

from __future__ import annotations

import math

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.schemes.base import MemoryScheme

SERIES_BELOW = 0.02  # rounding: of step over relaxation time, below it the difference would cancel
# Of (x - 1 + exp(-x))/x^2, the highest power first.
SERIES = [(-1) ** k / math.factorial(k + 2) for k in range(5, -1, -1)]


def weights(moduli: Array, ratios: Array) -> tuple[Array, Array]:
    """Average over the step of each branch's stress: per increment, and of its past."""
    fade = -np.expm1(-ratios) / ratios
    ramp = (1 - fade) / ratios
    small = ratios < SERIES_BELOW
    if small.any():  # the difference would cancel
        ramp[small] = np.polyval(SERIES, ratios[small])
    return moduli * ramp, moduli * fade


MEMBER = MemoryScheme(order=2, sample=0.5, lever=0.5, weights=weights)
