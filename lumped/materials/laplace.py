"""Numerical inversion of Laplace transforms: a modulus known only as E(s), back in time, with its error."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault
from lumped.numbers import Array

Complex = NDArray[np.complex128]
Transform = Callable[[Complex], Complex]

# Talbot's contour z = N (A theta cot(B theta) - C + i D theta), with the numbers that converge fastest, as
# 3.89^-N (Weideman 2006, doi 10.1137/050625837; Trefethen, Weideman and Schmelzer 2006, doi 10.1007/s10543-006-0077-9).
A, B, C, D = 0.5017, 0.6407, 0.6122, 0.2645
# The finer order is exact up to rounding, which grows as exp(0.17 N); the coarser errs by about 4e-12.
FINE, COARSE = 24, 20
# Rounding of the transform itself and of the sum, in units of the last place of the largest term.
ROUNDING = 8.0 * float(np.finfo(float).eps)


@dataclass(frozen=True, eq=False)
class Inverse:
    """f(t) at the times asked for, and the half-width of its error, both of their shape."""

    value: Array
    error: Array


def inverse(transform: Transform, times: ArrayLike) -> Inverse:
    """f(t) for t > 0, s, from its transform F(s); the error is the distance of two orders, and rounding.

    `transform` maps complex s, 1/s, of any shape to F(s) of that shape. It has to be analytic off the
    negative real axis, as that of every sum or integral of decaying exponentials is. Raises BadInput for a time
    that is not positive and finite.
    """
    t = np.asarray(times, dtype=float)
    if not np.all(np.isfinite(t)) or np.any(t <= 0.0):
        raise BadInput(Fault("laplace", "times", "accepted: finite times above zero, in s"))
    fine, largest = _contour_sum(transform, t, FINE)
    coarse, _ = _contour_sum(transform, t, COARSE)
    return Inverse(fine, np.abs(fine - coarse) + ROUNDING * largest)


def relaxation_modulus(operational: Transform, times: ArrayLike, viscosity: float = 0.0) -> Inverse:
    """E(t), Pa, at t > 0 from the operational modulus Q/P = s L{E(t)} of "(13)" to "(16)".

    A parallel `viscosity`, Pa s, is a pulse at t = 0, unseen later: taken away first, it leaves its rounding alone.
    """
    found = inverse(lambda s: operational(s) / s - viscosity, times)
    _, pulse = _contour_sum(lambda s: np.full_like(s, viscosity), np.asarray(times, dtype=float), FINE)
    return Inverse(found.value, found.error + ROUNDING * pulse)


def _contour_sum(transform: Transform, t: Array, order: int) -> tuple[Array, Array]:
    """The trapezoidal rule on the upper half of the contour, and the sum of the sizes of its terms."""
    theta = (2.0 * np.arange(order // 2) + 1.0) * np.pi / order
    cot = 1.0 / np.tan(B * theta)
    z = order * (A * theta * cot - C + 1j * D * theta)
    dz = A * cot - A * B * theta / np.sin(B * theta) ** 2 + 1j * D
    s: Complex = np.asarray(z / t[..., None], dtype=complex)
    terms = -2j * np.exp(z) * dz * transform(s) / t[..., None]
    return terms.real.sum(axis=-1), np.abs(terms).sum(axis=-1)
