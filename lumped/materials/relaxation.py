"""The relaxation modulus, a Prony series plus at most one parallel viscosity, and its twin, the creep compliance.

Each is the other's reciprocal, a sum of simple fractions; after the last load the creep alone says what recovers.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault
from lumped.numbers import Array, bisected

# The load d^(3/2) of a depth that is a half sine over time rises by at most so many peaks per duration.
STEEPEST = 3.0


@dataclass(frozen=True)
class Fidelity:
    """Largest relative deviation of a series from its modulus at times in `window`, s, before it and after it.

    Infinite where nothing is known. Raises BadInput.
    """

    window: tuple[float, float]
    inside: float
    before: float = math.inf
    after: float = math.inf

    def __post_init__(self) -> None:
        shortest, longest = self.window
        if not 0.0 < shortest <= longest < math.inf:
            raise BadInput(Fault("material", "fit_window", "accepted: shortest <= longest, both finite and above zero"))
        if not all(deviation >= 0.0 for deviation in (self.inside, self.before, self.after)):
            raise BadInput(Fault("material", "fit_error", "accepted: relative deviations >= 0"))

    def of_force(self, duration: float) -> float:
        """Bound of the deviation in the force of an impact this long, s, relative to its peak.

        F = int E(t-s) dy(s) deviates by what E does at the ages t-s it meets, from zero to the duration; the
        load of the ages below the window is a small share of all when the impact is much longer.
        """
        shortest, longest = self.window
        if duration > longest:
            return max(self.inside, self.before, self.after)
        young = STEEPEST * shortest
        return self.inside + (self.before if duration <= young else young / duration * self.before)


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
        numbers = self.equilibrium, self.viscosity, *self.moduli, *self.times
        if len(self.moduli) != len(self.times):
            raise BadInput(Fault("material", "", "moduli and times differ in length"))
        if not all(0.0 <= number < math.inf for number in numbers) or 0.0 in self.times:
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
    def spring(self) -> float:
        """Modulus of the spring that stands for the material, Pa: what is left of it, of a fluid what it has at once.

        Zero of a dashpot alone.
        """
        return self.relaxed or self.glassy

    @property
    def is_elastic(self) -> bool:
        """No memory at all: neither a Prony term nor a viscosity."""
        return not self.moduli and self.viscosity == 0.0

    def __call__(self, time: ArrayLike) -> Array:
        """E(t) for t > 0 (without the pulse of the viscosity at t = 0), same shape as `time`, Pa."""
        return decaying(self.equilibrium, self.moduli, self.times, time)

    def felt(self, time: ArrayLike, power: float) -> tuple[Array, Array]:
        """Moduli, Pa, that a load ~ t^power and its mean have felt a time t > 0, s, after it began; scalars or arrays.

        int E(t-s) d(s^p) / t^p and the same for p+1: of a branch M(1, p+1, -x) = 1 - x M(1, p+2, -x)/(p+1) with
        x = t/tau, DLMF 13.4.1 and 13.3.
        """
        from scipy.special import hyp1f1

        since = np.asarray(time, dtype=float)
        now = self.equilibrium + self.viscosity * power / since
        mean = self.equilibrium + self.viscosity * (power + 1.0) / since
        for modulus, tau in zip(self.moduli, self.times, strict=True):
            of_mean = hyp1f1(1.0, power + 2.0, -since / tau)
            now = now + modulus * (1.0 - since / tau * of_mean / (power + 1.0))
            mean = mean + modulus * of_mean
        return np.asarray(now), np.asarray(mean)

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

    def stretched(self, factor: float) -> Relaxation:
        """Everything `factor` > 0 times as slow: E(t/factor)."""
        times, known = tuple(factor * time for time in self.times), self.fidelity
        shortest, longest = known.window if known else (0.0, 0.0)
        window = known and replace(known, window=(factor * shortest, factor * longest))
        return Relaxation(self.equilibrium, self.moduli, times, factor * self.viscosity, window)

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

    def __add__(self, other: Creep) -> Creep:
        """Of two bodies under one load."""
        compliances, times = self.compliances + other.compliances, self.times + other.times
        return Creep(self.instantaneous + other.instantaneous, compliances, times, self.fluidity + other.fluidity)

    def __call__(self, time: ArrayLike) -> Array:
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


@dataclass(frozen=True)
class Recovery:
    """u(t) = permanent + sum_k amplitudes_k exp(-t/times_k), in the unit of the strain; times in s.

    What is left of a strain once nothing presses any more. With the strain u(0), the strains y_k of the dashpots in the
    branches and no stress from then on, the transforms of E_inf u + sum_k E_k z_k + eta u' = 0 and z_k = u - y_k,
    z_k' = u' - z_k/tau_k, give

        u(s) = sJ(s) N(s) ,    N(s) = sum_k E_k tau_k y_k(0)/(1 + s tau_k) + eta u(0) ,

    with the creep compliance J. The poles of N are zeros of sJ(s), so that the poles of the creep alone are left: one
    exponential a retardation time, and for a fluid what stays. Whatever springs hold at first is let go at once.
    """

    permanent: float
    amplitudes: tuple[float, ...] = ()
    times: tuple[float, ...] = ()

    @classmethod
    def of(cls, relaxation: Relaxation, strain: float, dashpots: Sequence[float] | Array) -> Recovery:
        """From the strain (told by a viscosity alone) and those of the branches' dashpots, (k,), all in one unit."""
        creep = relaxation.creep()
        branches = np.array([relaxation.moduli, relaxation.times, dashpots], dtype=float)
        moduli, taus, flowed = branches[:, branches[0] > 0.0]
        pulls = moduli * taus * flowed
        damped = relaxation.viscosity * strain
        retardation = np.array(creep.times)
        answers = np.array(creep.compliances) / retardation
        apart = 1.0 - taus / retardation[:, None]
        # a branch too weak to tell retardation from relaxation holds nothing back
        released = np.divide(pulls, apart, out=np.zeros_like(apart), where=apart != 0.0).sum(axis=1) + damped
        stays = creep.fluidity * (float(pulls.sum()) + damped)
        return cls(stays, tuple((answers * released).tolist()), creep.times)

    def __call__(self, time: ArrayLike) -> Array:
        """What is left at times >= 0, s, of any shape."""
        return decaying(self.permanent, self.amplitudes, self.times, time)

    def until(self, share: float) -> float:
        """Time, s, at which a share of what goes is left; zero where nothing goes. Raises BadInput."""
        if not 0.0 < share < 1.0:
            raise BadInput(Fault("recovery", "share", f"{share:g}: accepted between 0 and 1"))
        goes = float(self(0.0)) - self.permanent
        if goes == 0.0:
            return 0.0
        most = float(np.abs(self.amplitudes).sum())
        last = (1.0 + np.log(most / (share * abs(goes)))) * max(self.times)

        return bisected(lambda time: (float(self(time)) - self.permanent) / goes > share, 0.0, last)[1]


def decaying(constant: float, amplitudes: Sequence[float], times: Sequence[float], at: ArrayLike) -> Array:
    """constant + sum_k amplitudes_k exp(-t/times_k) at times of any shape."""
    t = np.asarray(at, dtype=float)
    value = np.full(t.shape, constant)
    for amplitude, tau in zip(amplitudes, times, strict=True):
        value = value + amplitude * np.exp(-t / tau)
    return value


@lru_cache(maxsize=64)  # the same few materials are asked again and again in one impact
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
