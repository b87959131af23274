"""The exponential of small matrices, many at once, without the threads that a library's solver starts for each."""

from __future__ import annotations

from math import ceil, log2

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
REACH, TERMS = 0.5, 15  # the series leaves out 0.5^16/16!


def exponential(matrices: Array) -> Array:
    """exp of each of (..., n, n): Taylor series of the matrix over 2^k, squared k times.

    What is squared is exp - 1, (1 + e)^2 - 1 = 2 e + e^2: beside the unit matrix small numbers would lose their digits.
    """
    norm = float(np.abs(matrices).sum(axis=-1).max())
    squarings = max(0, ceil(log2(norm / REACH))) if norm > 0.0 else 0
    scaled, unit = matrices * 0.5**squarings, np.eye(matrices.shape[-1])
    rest = scaled / TERMS
    for term in range(TERMS - 1, 0, -1):
        rest = (scaled + scaled @ rest) / term
    for _ in range(squarings):
        rest = 2.0 * rest + rest @ rest
    return np.asarray(unit + rest)
