"""Motions of a body in which volume and shape do no work on one another, and its compliance at every ratio of moduli.

With the stiffnesses V of unit bulk modulus and S of unit shear modulus, K V + G S is a pencil in G/K: condensed to the
contact surface it is a rational function, with which the motions of the body under surface loads at a few ratios agree,
and its slope too (rational Krylov space, both sides alike). Its poles lie at G/K <= 0, so that on an interval of
positive ratios the error falls by an order of magnitude and more with every ratio (Druskin, Knizhnerman and Zaslavsky
2009, doi:10.1137/080742403); it enters like rounding.

Projected on one another the motions need no interior: with C_i the surface compliance at ratio i and X_i the motions
there, X_i^T (K_j V + G_j S) X_j = C_i, two equations for every pair. On the diagonal X_i^T S X_i is computed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import eigh

from fe_contact.assembly.cache import Recipe, cached
from fe_contact.assembly.disk_cache import on_disk
from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import ElasticBody, SurfaceOperator, moduli
from fe_contact.errors import RatioNotKnown

FEWEST, PER_E_FOLD = 3, 0.5  # ratios, at least and for every factor e of the interval: errors of some 1e-7
LEAST_HALF_WIDTH = 0.3  # of the interval's logarithm: closer ratios would cancel
STIFFEST = 1e3  # ratio from which on volume is so soft beside shape that not even what is free to swell bends more
TABULATED = 1e-10  # accuracy of the stiffness between the ratios at which it is known
BEYOND = 3.0  # times the interval's ends: up to there the compliance errs by 2e-5 (measured), at 30 times by 2e-3
INDEPENDENT = 1e-12  # share of the largest energy below which a direction is rounding


@dataclass(frozen=True, eq=False)
class Modes:
    """Surface displacement ``shape`` (n, m) of m motions; ``volume``, ``shear`` (m,) their stiffness per modulus.

    ``operator``: the elastic body's at one Poisson's ratio of the interval; ``ratios``: how many were factorised;
    ``interval`` (2,) of the ratios G/K that the motions were made for.
    """

    shape: Array
    volume: Array
    shear: Array
    operator: SurfaceOperator
    ratios: int
    interval: Array

    @property
    def solves(self) -> int:
        """One a node of the contact zone and ratio."""
        return self.ratios * len(self.operator.stiffness)

    def stiffer(self, share: float) -> Modes:
        """Of a body so many times as stiff."""
        return replace(self, volume=share * self.volume, shear=share * self.shear)

    def compliance(self, bulk: float, shear: float) -> Array:
        """Normal displacement of the contact zone's nodes under unit forces there, (n, n), symmetric."""
        return np.asarray((self.shape / (bulk * self.volume + shear * self.shear)) @ self.shape.T)

    def stiffness(self, ratio: float) -> Array:
        """Its inverse at a ratio of the moduli, (n, n), for E* = 1: a polynomial in the ratio's logarithm.

        Chebyshev's points: the poles lie at ratios below zero, whose logarithms are pi away from the interval. Raises
        RatioNotKnown far outside it.
        """
        low, high = self.interval
        if not low / BEYOND <= min(ratio, STIFFEST) <= high * BEYOND:
            raise RatioNotKnown(ratio, low, high)
        places, values = self._table
        place = np.log(ratio)
        if not places[0] <= place <= places[-1] or place in places:
            return self._condensed(ratio)
        weights = np.where(np.arange(places.size) % 2, -1.0, 1.0) / (place - places)
        weights[[0, -1]] *= 0.5
        return np.asarray(np.tensordot(weights / weights.sum(), values, axes=1))

    @cached_property
    def _table(self) -> tuple[Array, Array]:
        """Logarithms of ratios, (p,), ascending, and the stiffness there, (p, n, n)."""
        low, high = np.log(self.interval)
        half = max(0.5 * (high - low), LEAST_HALF_WIDTH)
        gain = np.log((np.pi + np.hypot(np.pi, half)) / half)  # of accuracy with every point
        places = 0.5 * (low + high) - half * np.cos(np.linspace(0.0, np.pi, 2 + int(-np.log(TABULATED) / gain)))
        return places, np.array([self._condensed(ratio) for ratio in np.exp(places)])

    def _condensed(self, ratio: float) -> Array:
        return _symmetric(np.asarray(np.linalg.inv(self.compliance(*moduli(poisson(ratio))))))


@cached
@on_disk
def modes(body: Recipe[ElasticBody], lowest: float, highest: float) -> Modes:
    """Of a body whose ratio of shear to bulk modulus, G/K > 0, stays within an interval."""
    elastic = body.follow()
    sheared = elastic.stiffness(0.0, 1.0).tocsr()
    bodies = (elastic.condensed(poisson(ratio), sheared) for ratio in _ratios(lowest, highest))
    operators, works = zip(*((one.operator, one.work) for one in bodies), strict=True)
    middle = operators[len(operators) // 2]
    bulk, shear = moduli(middle.poisson)
    volume_work, shear_work = _projected(operators, works)
    free = _independent(bulk * volume_work + shear * shear_work)
    share, turned = eigh(free.T @ (shear * shear_work) @ free)
    share = np.clip(share, 0.0, 1.0)  # of the stiffness at the middle ratio
    shape = np.hstack([_compliance(operator) for operator in operators]) @ (free @ turned)
    interval = np.minimum([lowest, highest], STIFFEST)
    return Modes(shape, (1.0 - share) / bulk, share / shear, middle, len(operators), interval)


def poisson(ratio: float) -> float:
    """Poisson's ratio where shear over bulk modulus is a ratio."""
    return (3.0 - 2.0 * ratio) / (2.0 * (3.0 + ratio))


def _ratios(lowest: float, highest: float) -> Array:
    """Chebyshev's points in the logarithm, within what bends the answer."""
    ends = np.log(np.minimum([lowest, highest], STIFFEST))
    half = max(0.5 * float(ends[1] - ends[0]), LEAST_HALF_WIDTH)
    count = FEWEST + round(PER_E_FOLD * 2.0 * (half - LEAST_HALF_WIDTH))
    places = np.cos(np.pi * (np.arange(count) + 0.5) / count)
    return np.asarray(np.exp(ends.mean() + half * places))


def _projected(operators: Sequence[SurfaceOperator], works: Sequence[Array | None]) -> tuple[Array, Array]:
    """Work on one another, of unit bulk and of unit shear modulus, of the motions under unit nodal forces; ``works``:
    that of unit shear modulus on themselves.
    """
    n, count = len(operators[0].stiffness), len(operators)
    volume, shear = (np.empty((count, n, count, n)) for _ in range(2))
    for i, (first, work) in enumerate(zip(operators, works, strict=True)):
        bulk_i, shear_i = moduli(first.poisson)
        assert work is not None  # it was asked for
        shear[i, :, i] = _symmetric(work)
        volume[i, :, i] = (_compliance(first) - shear_i * shear[i, :, i]) / bulk_i
        for j, second in enumerate(operators[:i]):
            bulk_j, shear_j = moduli(second.poisson)
            lead, determinant = (_compliance(first), _compliance(second)), bulk_j * shear_i - bulk_i * shear_j
            volume[i, :, j] = volume[j, :, i] = (shear_i * lead[0] - shear_j * lead[1]) / determinant
            shear[i, :, j] = shear[j, :, i] = (bulk_j * lead[1] - bulk_i * lead[0]) / determinant
    return volume.reshape(count * n, -1), shear.reshape(count * n, -1)


def _independent(work: Array) -> Array:
    """Combinations (all, m) of the motions that do unit work on themselves and none on one another."""
    scale = 1.0 / np.sqrt(np.diag(work))
    energy, directions = eigh(scale[:, None] * work * scale)
    kept = energy > INDEPENDENT * energy[-1]
    return np.asarray(scale[:, None] * directions[:, kept] / np.sqrt(energy[kept]))


def _compliance(operator: SurfaceOperator) -> Array:
    """Of the contact zone, (n, n)."""
    return _symmetric(operator.response[: len(operator.stiffness)])


def _symmetric(matrix: Array) -> Array:
    return np.asarray(0.5 * (matrix + matrix.T))


class Condensed:
    """Condensed once, on one mesh."""

    if TYPE_CHECKING:  # members have it as a field or as a property

        @property
        def operator(self) -> SurfaceOperator: ...

    @property
    def factorizations(self) -> int:
        """One for one mesh."""
        return 1

    @property
    def solves(self) -> int:
        """One a node of the contact zone."""
        return len(self.operator.stiffness)


class ByModes:
    """Condensed at every ratio of the moduli that its modes were made for, whatever the steps."""

    modes: Modes

    @property
    def factorizations(self) -> int:
        """One a ratio."""
        return self.modes.ratios

    @property
    def solves(self) -> int:
        """Those of the modes."""
        return self.modes.solves
