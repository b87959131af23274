"""The reciprocal of an operational modulus as a sum of simple fractions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def reciprocal(
    equilibrium: float, moduli: tuple[float, ...], times: tuple[float, ...], viscosity: float
) -> tuple[float, tuple[float, ...], tuple[float, ...], float]:
    """Partial fractions of 1/Q, Q(s) = equilibrium + sum_k moduli_k s t_k/(1 + s t_k) + viscosity s.

    Returns (J_g, J_k, lambda_k, fluidity) with 1/Q(s) = J_g + sum_k J_k/(1 + s lambda_k) + fluidity/s.
    The zeros of Q are the (negative) eigenvalues of a symmetric matrix, polished by Newton steps on Q;
    every weight is 1/Q' at a zero, and Q' is a sum of positive terms, so no digit is cancelled.
    """
    weights, taus = _merged(moduli, times)
    rates = _polished(_rates(equilibrium, weights, taus, viscosity), equilibrium, weights, taus, viscosity)
    compliances = 1.0 / (rates * _slope(rates, weights, taus, viscosity))
    kept = compliances > 0.0
    glassy = 0.0 if viscosity > 0.0 else 1.0 / (equilibrium + float(weights.sum()))
    fluidity = 1.0 / (float(weights @ taus) + viscosity) if equilibrium == 0.0 else 0.0
    retardation = 1.0 / rates
    return glassy, tuple(compliances[kept].tolist()), tuple(retardation[kept].tolist()), fluidity


def _merged(moduli: tuple[float, ...], times: tuple[float, ...]) -> tuple[Array, Array]:
    """Terms of equal time as one, terms without weight left out, in order of time."""
    taus, where = np.unique(np.array(times, dtype=float), return_inverse=True)
    weights = np.zeros(taus.size)
    np.add.at(weights, where, moduli)
    return weights[weights > 0.0], taus[weights > 0.0]


def _rates(equilibrium: float, weights: Array, taus: Array, viscosity: float) -> Array:
    """Rates p > 0 with Q(-p) = 0: eigenvalues of the free evolution of the dashpots under zero stress."""
    if viscosity > 0.0:
        coupling = -np.sqrt(weights / taus / viscosity)
        matrix = np.diag(np.append((equilibrium + weights.sum()) / viscosity, 1.0 / taus))
        matrix[0, 1:] = matrix[1:, 0] = coupling
    else:
        share = np.sqrt(weights / (equilibrium + weights.sum()) / taus)
        matrix = np.diag(1.0 / taus) - np.outer(share, share)
    rates = np.linalg.eigvalsh(matrix)
    return rates[1:] if equilibrium == 0.0 else rates


def _polished(rates: Array, equilibrium: float, weights: Array, taus: Array, viscosity: float) -> Array:
    """Newton steps on Q(-p), each kept only where it is small: the eigenvalues are already close."""
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(3):
            lag = rates[:, None] * taus
            value = equilibrium - viscosity * rates - (weights * lag / (1.0 - lag)).sum(axis=1)
            step = value / _slope(rates, weights, taus, viscosity)
            rates = np.where(np.abs(step) < 1e-3 * np.abs(rates), rates + step, rates)
    return rates


def _slope(rates: Array, weights: Array, taus: Array, viscosity: float) -> Array:
    """Q'(s) at s = -rates."""
    with np.errstate(divide="ignore"):
        return np.asarray((weights * taus / (1.0 - rates[:, None] * taus) ** 2).sum(axis=1) + viscosity)
