"""The creep compliance, the twin of the relaxation modulus."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.materials.reciprocal import reciprocal
from lumped.materials.relaxation import Relaxation


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

    def operational(self, s: ArrayLike) -> NDArray[Any]:
        """s times the Laplace transform of J, 1/Pa, for `s` as in `Relaxation.operational`."""
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
