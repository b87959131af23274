"""J2 plasticity with linear isotropic hardening at small strain: the radial return of a step.

Strains and stresses of a plane of revolution in components (rr, rz, zz, tt), tensor components, symmetric.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lumped.numbers import Array

ROOT = math.sqrt(1.5)  # von Mises' stress over the length of the deviator
# Displacement gradient (rr, rz, zr, zz, tt) to strain (rr, rz, zz, tt), and how often each component stands in a sum.
SYMMETRIC = np.array([[1.0, 0, 0, 0, 0], [0, 0.5, 0.5, 0, 0], [0, 0, 0, 1.0, 0], [0, 0, 0, 0, 1.0]])
GRADIENT = [0, 1, 1, 2, 3]  # components of a symmetric tensor by those of a gradient
OFTEN = np.array([1.0, 2.0, 1.0, 1.0])
VOLUME = np.array([1.0, 0.0, 0.0, 1.0, 1.0])  # of a gradient: its trace
DEPTHS = np.linspace(0.0, 1.5, 301)  # over the contact radius: Hertz' contacts yield first within, C to 1e-5


def first_yield(nu: float, plane: bool = False) -> float:
    """C: a Hertz contact first yields, by von Mises, where its peak pressure is C Y; 1.61 at nu = 0.3, 0.67 at -0.8.

    The largest stress on the axis (Johnson, ISBN 978-0-521-34796-9, eq. 3.45) or, for nu below -0.34, at the edge of
    the contact, where (1 - 2 nu)/3 of the pressure pulls outwards and pushes around. In ``plane`` strain below the
    middle, or at it for nu below 0.19 (eq. 4.46); 1.79 at nu = 0.3.
    """
    if plane:
        root = np.sqrt(1.0 + DEPTHS**2)
        along, across = -1.0 / root, 2.0 * DEPTHS - (1.0 + 2.0 * DEPTHS**2) / root
        held = nu * (along + across)
        return 1.0 / float(np.sqrt(0.5 * ((along - across) ** 2 + (across - held) ** 2 + (held - along) ** 2)).max())
    angle = np.arctan2(1.0, DEPTHS)
    along, across = -1.0 / (1.0 + DEPTHS**2), 0.5 / (1.0 + DEPTHS**2) - (1.0 + nu) * (1.0 - DEPTHS * angle)
    return 1.0 / max(float(np.abs(along - across).max()), (1.0 - 2.0 * nu) / math.sqrt(3.0))


@dataclass(frozen=True, eq=False)
class PlasticStep:
    """What points answer at the end of a step, of any shape (...): ``stress`` (5, ...) by the components of the
    gradient, Pa; ``energy`` (...), J/m3, the incremental potential of it and of the tangent; ``strain`` (4, ...) and
    ``amount`` (...) of plastic strain in the end. Of the trial deviator the share that is ``kept``, by how much the
    body is ``softer`` along its ``direction`` (4, ...), and the ``moduli`` of bulk and shear, Pa.
    """

    stress: Array
    energy: Array
    strain: Array
    amount: Array
    kept: Array
    softer: Array
    direction: Array
    moduli: tuple[float, float]

    @cached_property
    def tangent(self) -> Array:
        """Consistent derivative of the stress, (5, 5, ...): K 1(x)1 + 2G (kept I_dev - softer n(x)n)."""
        bulk, shear = self.moduli
        deviatoric = SYMMETRIC.T @ (OFTEN[:, None] * SYMMETRIC) - np.outer(VOLUME, VOLUME) / 3.0
        normal = self.direction[GRADIENT]
        tangent = -2.0 * shear * self.softer * normal[:, None] * normal[None]
        tangent += 2.0 * shear * np.multiply.outer(deviatoric, self.kept)
        fixed = bulk * np.outer(VOLUME, VOLUME)
        tangent += fixed.reshape(5, 5, *[1] * self.kept.ndim)
        return np.asarray(tangent)


@dataclass(frozen=True)
class Yielding:
    """Bulk and shear modulus, yield strength and hardening modulus, Pa: it yields at Y + H alpha, von Mises.

    alpha is the amount of plastic strain, sqrt(2/3) times the length of its path.
    """

    bulk: float
    shear: float
    strength: float
    hardening: float = 0.0

    def flowed(self, gradient: Array, strain: Array, amount: Array) -> PlasticStep:
        """The step to a displacement ``gradient`` (5, ...) from plastic ``strain`` (4, ...) of an ``amount`` (...).

        Backward Euler's radial return, de Souza Neto et al. 2008 (ISBN 978-0-470-69452-7), box 7.5, with the tangent of
        Simo and Taylor 1985 (10.1016/0045-7825(85)90070-2). Its potential is K/2 tr^2 + G d:d - <f>^2/(2 (3G + H)), d
        the trial deviator and f how far it lies beyond yield.
        """
        shear, rigid = self.shear, 3.0 * self.shear + self.hardening
        volume, trial, length = self._trial(gradient, strain)
        mises = 2.0 * shear * ROOT * length
        beyond = np.maximum(mises - self.strength - self.hardening * amount, 0.0)
        more, yields = beyond / rigid, beyond > 0.0
        direction = trial / np.where(length > 0.0, length, 1.0)
        kept = np.where(yields, 1.0 - 3.0 * shear * more / np.where(yields, mises, 1.0), 1.0)
        deviator = 2.0 * shear * kept * trial
        stress = deviator[GRADIENT] + np.multiply.outer(VOLUME, self.bulk * volume)
        softer = np.where(yields, 3.0 * shear / rigid - (1.0 - kept), 0.0)
        return PlasticStep(
            stress=stress,
            energy=0.5 * self.bulk * volume**2 + shear * length**2 - beyond**2 / (2.0 * rigid),
            strain=strain + ROOT * more * direction,
            amount=amount + more,
            kept=kept,
            softer=softer,
            direction=direction,
            moduli=(self.bulk, self.shear),
        )

    def stored(self, gradient: Array, strain: Array) -> Array:
        """Elastic energy, J/m3, (...), at a displacement gradient (5, ...) and plastic strain (4, ...)."""
        volume, _, length = self._trial(gradient, strain)
        return np.asarray(0.5 * self.bulk * volume**2 + self.shear * length**2)

    def worked(self, amount: Array) -> Array:
        """Plastic work, J/m3, (...), along any path to an ``amount`` (...) of plastic strain: Y alpha + H alpha^2/2."""
        return np.asarray((self.strength + 0.5 * self.hardening * amount) * amount)

    def _trial(self, gradient: Array, strain: Array) -> tuple[Array, Array, Array]:
        """Volume (...), deviator (4, ...) and its length (...) of the elastic strain if nothing flowed."""
        volume = gradient[0] + gradient[3] + gradient[4]
        whole = np.stack([gradient[0], 0.5 * (gradient[1] + gradient[2]), gradient[3], gradient[4]])
        whole[[0, 2, 3]] -= volume / 3.0
        trial = whole - strain
        return volume, trial, np.sqrt(np.einsum("c,c...,c...->...", OFTEN, trial, trial))
