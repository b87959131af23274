"""The relaxation modulus, a Prony series plus at most one parallel viscosity, and its twin, the creep compliance.

The reciprocal of an operational modulus as a sum of simple fractions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault
from lumped.materials.fidelity import Fidelity

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Relaxation:
    """E(t) = equilibrium + sum_k moduli_k exp(-t/times_k) + viscosity * dirac(t).

    Moduli in Pa, times in s, viscosity in Pa s. `fidelity` is how far the series stands from the modulus which
    it was fitted to, None where it is the modulus itself. Raises BadInput for a negative or non-finite value,
    a time that is not positive, lists of different length, or a modulus that is nothing at all.
    """

    equilibrium: float
    moduli: tuple[float, ...] = ()
    times: tuple[float, ...] = ()
    viscosity: float = 0.0
    fidelity: Fidelity | None = None

    def __post_init__(self) -> None:
        numbers = np.array([self.equilibrium, self.viscosity, *self.moduli, *self.times], dtype=float)
        if len(self.moduli) != len(self.times):
            raise BadInput(Fault("material", "", "moduli and times differ in length"))
        if not np.all(np.isfinite(numbers)) or np.any(numbers < 0.0) or 0.0 in self.times:
            raise BadInput(Fault("material", "", "moduli and viscosity are >= 0, times > 0, all finite"))
        if self.equilibrium + sum(self.moduli) + self.viscosity <= 0.0:
            raise BadInput(Fault("material", "", "every modulus and the viscosity are zero"))

    @property
    def glassy(self) -> float:
        """Sum of all springs, E(0+) without the viscosity, Pa."""
        return self.equilibrium + sum(self.moduli)

    @property
    def instantaneous(self) -> float:
        """Modulus against a sudden strain, Pa; infinite with a viscosity."""
        return float("inf") if self.viscosity > 0.0 else self.glassy

    @property
    def relaxed(self) -> float:
        """Modulus left after a long time, Pa; zero for a fluid."""
        return self.equilibrium

    @property
    def is_elastic(self) -> bool:
        """No memory at all: neither a Prony term nor a viscosity."""
        return not self.moduli and self.viscosity == 0.0

    def __call__(self, time: ArrayLike) -> NDArray[np.float64]:
        """E(t) for t > 0 (without the pulse of the viscosity at t = 0), same shape as `time`, Pa."""
        t = np.asarray(time, dtype=float)
        value = np.full(t.shape, self.equilibrium)
        for modulus, tau in zip(self.moduli, self.times, strict=True):
            value = value + modulus * np.exp(-t / tau)
        return value

    def operational(self, s: ArrayLike) -> NDArray[np.inexact]:
        """s times the Laplace transform of E, scalars or arrays, in Pa: Q(s)/P(s) of "(13)" to "(16)".

        `s`, 1/s, is positive, or complex off the negative real axis; at s = i omega this is the complex modulus,
        storage + i loss.
        """
        frequency = np.asarray(s)
        value = self.equilibrium + self.viscosity * frequency
        for modulus, tau in zip(self.moduli, self.times, strict=True):
            value = value + modulus * (frequency * tau) / (1.0 + frequency * tau)
        return value

    def scaled(self, factor: float) -> Relaxation:
        """The same times, every modulus and the viscosity multiplied by `factor` > 0."""
        moduli = tuple(factor * modulus for modulus in self.moduli)
        return Relaxation(factor * self.equilibrium, moduli, self.times, factor * self.viscosity, self.fidelity)

    def creep(self) -> Creep:
        """The creep compliance J(t) of the same material: E(s) J(s) = 1/s^2."""
        return Creep(*reciprocal(self.equilibrium, self.moduli, self.times, self.viscosity))


@dataclass(frozen=True)
class Creep:
    """J(t) = instantaneous + sum_k compliances_k (1 - exp(-t/times_k)) + fluidity * t.

    Compliances in 1/Pa, retardation times in s, fluidity in 1/(Pa s).
    """

    instantaneous: float
    compliances: tuple[float, ...] = ()
    times: tuple[float, ...] = ()
    fluidity: float = 0.0

    def __call__(self, time: ArrayLike) -> NDArray[np.float64]:
        """J(t) for t >= 0, same shape as `time`, 1/Pa."""
        t = np.asarray(time, dtype=float)
        value = self.instantaneous + self.fluidity * t
        for compliance, tau in zip(self.compliances, self.times, strict=True):
            value = value - compliance * np.expm1(-t / tau)
        return value

    def operational(self, s: ArrayLike) -> NDArray[np.inexact]:
        """s times the Laplace transform of J, scalars or arrays, 1/Pa, for `s` as in `Relaxation.operational`."""
        frequency = np.asarray(s)
        value = self.instantaneous + self.fluidity / frequency
        for compliance, tau in zip(self.compliances, self.times, strict=True):
            value = value + compliance / (1.0 + frequency * tau)
        return value

    def relaxation(self) -> Relaxation:
        """The relaxation modulus of the same material, the inverse of `Relaxation.creep`.

        s J(s) has the form of an operational relaxation modulus (equilibrium = fluidity, viscosity =
        instantaneous compliance, moduli = compliance/time), so one and the same inversion serves both ways.
        """
        rates = tuple(c / tau for c, tau in zip(self.compliances, self.times, strict=True))
        viscosity, weights, times, equilibrium = reciprocal(self.fluidity, rates, self.times, self.instantaneous)
        moduli = tuple(weight / tau for weight, tau in zip(weights, times, strict=True))
        return Relaxation(equilibrium, moduli, times, viscosity)


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
