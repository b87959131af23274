"""A material given by its differential operators, P sigma = Q epsilon, "(13)"."""

from typing import Annotated

import numpy as np

from lumped.materials.networks.base import Network
from lumped.materials.relaxation import Relaxation
from lumped.numbers import Array
from lumped.schema.keys import Key, Number, Numbers

COEFFICIENT = Number(-1e30, 1e30)
NEGLIGIBLE = 1e-11  # rounding: weights over the modulus: less below zero is forgiven, less above is dropped


def of(
    p: Annotated[tuple[float, ...], Key(Numbers(COEFFICIENT, most=21), "coefficients of P, ascending")],
    q: Annotated[tuple[float, ...], Key(Numbers(COEFFICIENT, most=22), "coefficients of Q, ascending")],
) -> Relaxation:
    """Partial fractions of Q(s)/(s P(s)): the weight at s = -1/tau_k is the modulus of that Prony term.

    `p`, `q`: coefficients in ascending powers of d/dt. Raises ValueError unless the operators are those of a
    network of springs and dashpots: deg q <= deg p + 1, poles real, negative and simple, weights positive.
    """
    below, above = _trimmed(p, q)
    if above.size > below.size + 1:
        raise ValueError(f"deg q = {above.size - 1} exceeds deg p + 1 = {below.size}; accepted: deg q <= deg p + 1")
    poles = _poles(below)
    weights = np.polyval(above[::-1], poles) / (poles * np.polyval(np.polyder(below[::-1]), poles))
    viscosity = float(above[-1] / below[-1]) if above.size == below.size + 1 else 0.0
    equilibrium = float(above[0] / below[0])
    scale = abs(equilibrium) + float(np.abs(weights).sum())
    if equilibrium < 0.0 or viscosity < 0.0 or np.any(weights < -NEGLIGIBLE * scale):
        raise ValueError("no network of springs and dashpots: a modulus or the viscosity is negative")
    kept = weights > NEGLIGIBLE * scale
    return Relaxation(equilibrium, tuple(weights[kept].tolist()), tuple((-1.0 / poles[kept]).tolist()), viscosity)


def _trimmed(p: tuple[float, ...], q: tuple[float, ...]) -> tuple[Array, Array]:
    """Without zero leading coefficients and without common factors d/dt."""
    below, above = np.trim_zeros(np.array(p), "b"), np.trim_zeros(np.array(q), "b")
    if below.size == 0 or above.size == 0:
        raise ValueError("p or q is zero throughout; accepted: at least one coefficient of each other than zero")
    while below[0] == 0.0 and above[0] == 0.0:
        below, above = below[1:], above[1:]
    if below[0] == 0.0:
        raise ValueError("p starts with zero where q does not: an infinite modulus at rest")
    return below, above


def _poles(below: Array) -> Array:
    """The roots of P, which a passive network has real, negative and simple."""
    roots = np.roots(below[::-1])
    spread = np.abs(np.subtract.outer(roots, roots))[~np.eye(roots.size, dtype=bool)]
    if np.any(np.abs(roots.imag) > 1e-9 * np.abs(roots)) or np.any(roots.real >= 0.0):
        raise ValueError("no network of springs and dashpots: a root of P is not real and negative")
    if spread.size and spread.min() < 1e-9 * np.abs(roots).min():
        raise ValueError("no network of springs and dashpots: P has a double root")
    return np.asarray(roots.real, dtype=float)


MEMBER = Network((of,))
