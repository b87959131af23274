"""An elastic annulus in plane strain, its outer circle fixed: radial displacement of the inner circle, wave by wave.

A pressure cos(n theta) on the inner circle, without shear, moves it by (inner radius/E*) c_n cos(n theta). Michell's
functions with their displacements and stresses: Barber 2010, ISBN 978-90-481-3808-1, tables 8.1 and 9.1; here 2 G = 1
and the inner radius is 1.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# c_n leaves that of a hole in an infinite body as (inner/outer)^(2n): the tail beyond exp(-TAIL) is not summed.
TAIL, LEAST_ORDER = 42.0, 12


@lru_cache(maxsize=64)
def compliances(nu: float, ratio: float) -> Array:
    """c_n, n = 0, 1, ..., as far as they differ from those of a hole; `ratio` is inner over outer radius."""
    last = LEAST_ORDER + int(np.ceil(-0.5 * TAIL / np.log(ratio)))
    per_shear = 1.0 / (1.0 - nu)
    return np.concatenate([[_uniform(nu, ratio)], per_shear * _waves(nu, ratio, np.arange(1.0, last + 1.0))])


def hole(nu: float, orders: Array) -> Array:
    """c_n = (2n + (1-2nu)/(1-nu))/(n^2-1) of a hole in an infinite body, n >= 2."""
    return np.asarray((2.0 * orders + (1.0 - 2.0 * nu) / (1.0 - nu)) / (orders**2 - 1.0))


def _uniform(nu: float, ratio: float) -> float:
    """n = 0: u = A r + B/r."""
    square, slack = ratio**-2, 1.0 - 2.0 * nu
    return (square - 1.0) * slack / ((1.0 - nu) * (1.0 + slack * square))


def _waves(nu: float, ratio: float, n: Array) -> Array:
    """u_r on the inner circle for n >= 1, shape (n,): four terms, no shear inside, no displacement outside."""
    inner_u, _, normal, shear = _terms(nu, n, 1.0, ratio)
    outer_u, outer_v, _, _ = _terms(nu, n, 1.0 / ratio, ratio)
    system = np.stack([normal, shear, outer_u, outer_v], axis=-2)
    load = np.zeros((n.size, 4, 1))
    load[:, 0] = -1.0
    return np.asarray((inner_u * np.linalg.solve(system, load)[..., 0]).sum(axis=-1))


def _terms(nu: float, n: Array, r: float, ratio: float) -> tuple[Array, Array, Array, Array]:
    """u_r, u_theta, sigma_rr, sigma_rtheta (cosine and sine parts) of four solutions at r, each of shape (n, 4).

    r^(n+2) and r^n are scaled to the outer circle. For n = 1 the third, a mere translation, gives its place to the
    single-valued solution of a force, (kappa+1) r theta sin(theta) - (kappa-1) r ln(r) cos(theta).
    """
    kappa, grown = 3.0 - 4.0 * nu, (r * ratio) ** (n - 1.0)
    rising = _michell_rising(kappa, n, r) * (grown * ratio**2)
    rigid = np.stack([-n, n, -n * (n - 1.0) / r, n * (n - 1.0) / r]) * grown
    falling = _michell_falling(kappa, n, r) * r ** (1.0 - n)
    decaying = np.stack([n, n, -n * (n + 1.0) / r, -n * (n + 1.0) / r]) * r ** (-1.0 - n)
    terms = np.stack([rising, rigid, falling, decaying], axis=-1)
    return terms[0], terms[1], terms[2], terms[3]


def _michell_rising(kappa: float, n: Array, r: float) -> Array:
    """r^(n+2) cos(n theta) over r^(n-1), shape (4, n)."""
    return np.stack([(kappa - n - 1.0) * r**2, (kappa + n + 1.0) * r**2, -(n + 1.0) * (n - 2.0) * r, n * (n + 1.0) * r])


def _michell_falling(kappa: float, n: Array, r: float) -> Array:
    """r^(2-n) cos(n theta) over r^(1-n), and for n = 1 the force's solution, shape (4, n)."""
    wave = np.stack([kappa + n - 1.0, n - 1.0 - kappa, -(n + 2.0) * (n - 1.0) / r, -n * (n - 1.0) / r])
    logarithm = 2.0 * kappa * np.log(r)
    force = np.array([logarithm - 1.0, -logarithm - 1.0, (kappa + 3.0) / r, (1.0 - kappa) / r])
    return np.where(n == 1.0, force[:, None], wave)
