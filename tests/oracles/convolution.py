"""The third route to the force: the hereditary sum with a modulus known only as E(s), no series between.

F(t) = int_0^t E(t-s) dy(s), "(17)" to "(19)", at a cost of O(n^2) for n samples.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault
from lumped.materials.laplace import Transform, inverse

Array = NDArray[np.float64]


def force(operational: Transform, step: float, load: ArrayLike) -> Array:
    """F, N, at times 0, step, 2 step ..., s, for the elastic load over the modulus, m2, at these times, (n,).

    `operational` maps complex s, 1/s, to s L{E(t)}, Pa. Exact for a load that is linear between the samples: what is
    inverted is the integral of E up to an age, so that a modulus which is infinite at first costs nothing; a
    parallel viscosity answers the mean rate of the last step. The load is zero at first. Raises BadInput.
    """
    y = np.asarray(load, dtype=float)
    if y.ndim != 1 or y.size < 2 or not np.all(np.isfinite(y)) or y[0] != 0.0:
        raise BadInput(Fault("convolution", "load", "accepted: two or more finite values, the first of them zero"))
    if not 0.0 < step < np.inf:
        raise BadInput(Fault("convolution", "step", "accepted: a finite time above zero, in s"))
    to_age = inverse(lambda s: operational(s) / s**2, step * np.arange(1, y.size)).value
    answer = np.diff(to_age, prepend=0.0) / step
    return np.concatenate([[0.0], np.convolve(np.diff(y), answer)[: y.size - 1]])
