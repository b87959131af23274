"""Motions of a body in which volume and shape do no work on one another, and its compliance at every ratio of moduli.

With the stiffnesses V of unit bulk modulus and S of unit shear modulus, K V + G S is a pencil in G/K: condensed to the
contact surface it is a rational function, with which the motions of the body under surface loads at a few ratios agree,
and its slope too (rational Krylov space, both sides alike). Its poles lie at G/K <= 0, so that on an interval of
positive ratios the error falls by an order of magnitude and more with every ratio (Druskin, Knizhnerman and Zaslavsky
2009, doi:10.1137/080742403); it enters like rounding.

Projected on one another the motions need no interior: with C_i the surface compliance at ratio i and X_i the motions
there, X_i^T (K_j V + G_j S) X_j = C_i, two equations for every pair. On the diagonal X_i^T S X_i = -dC_i/dG, which is
the imaginary part where that of the shear modulus is so small that its square vanishes beside one (Squire and Trapp
1998, doi:10.1137/S003614459631241X). So the surface alone is solved for: all else is eliminated, and the motions
within are never known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.linalg import eigh

from fe_contact.assembly.cache import Recipe, cached
from fe_contact.assembly.disk_cache import on_disk
from fe_contact.assembly.forms import Array, Matrix
from fe_contact.assembly.interior import Eliminated, elimination_order
from fe_contact.assembly.operators import ElasticBody, SurfaceOperator, moduli, normals, seen_through
from fe_contact.errors import RatioNotKnown

FEWEST, PER_E_FOLD = 3, 0.5  # ratios, at least and for every factor e of the interval: errors of some 1e-7
LEAST_HALF_WIDTH = 0.3  # of the interval's logarithm: closer ratios would cancel
STIFFEST = 1e3  # ratio from which on volume is so soft beside shape that not even what is free to swell bends more
TABULATED = 1e-10  # accuracy of the stiffness between the ratios at which it is known
BEYOND = 3.0  # times the interval's ends: up to there the compliance errs by 2e-5 (measured), at 30 times by 2e-3
INDEPENDENT = 1e-12  # share of the largest energy below which a direction is rounding
IMAGINARY = 1e-20  # part of the shear modulus: its square is beyond rounding, and itself far from the least number


@dataclass(frozen=True, eq=False)
class Modes:
    """Surface displacement ``shape`` (n, m) of m motions; ``volume``, ``shear`` (m,) their stiffness per modulus.

    ``operator``: the elastic body's at one Poisson's ratio of the interval; ``factorizations`` and back-substitutions,
    ``solves``, that it took; ``interval`` (2,) of the ratios G/K that the motions were made for.
    """

    shape: Array
    volume: Array
    shear: Array
    operator: SurfaceOperator
    factorizations: int
    solves: int
    interval: Array

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
    pencil = Pencil.of(body.follow())
    found = [pencil.at(ratio) for ratio in _ratios(lowest, highest)]
    volume_work, shear_work = _projected(found)
    middle = found[len(found) // 2]
    free = _independent(middle.bulk * volume_work + middle.shear * shear_work)
    share, turned = eigh(free.T @ (middle.shear * shear_work) @ free)
    share = np.clip(share, 0.0, 1.0)  # of the stiffness at the middle ratio
    return Modes(
        shape=np.hstack([one.compliance for one in found]) @ (free @ turned),
        volume=(1.0 - share) / middle.bulk,
        shear=share / middle.shear,
        operator=seen_through(pencil.body.basis, pencil.body.surface, middle.poisson, middle.response),
        factorizations=1 + len(found),  # the first tells the order of the others
        solves=0 if pencil.body.floating is None else len(found),
        interval=np.minimum([lowest, highest], STIFFEST),
    )


class AtRatio(NamedTuple):
    """A body whose ratio of moduli is known, for E* = 1, under unit nodal forces on its contact zone of n nodes.

    ``response`` (n_s, n): inward displacement of all surface nodes; ``work`` (n, n) of unit shear modulus.
    """

    poisson: float
    response: Array
    work: Array

    @property
    def bulk(self) -> float:
        """Bulk modulus."""
        return moduli(self.poisson)[0]

    @property
    def shear(self) -> float:
        """Shear modulus."""
        return moduli(self.poisson)[1]

    @property
    def compliance(self) -> Array:
        """Of the contact zone, (n, n)."""
        return _symmetric(self.response[: len(self.work)])


@dataclass(frozen=True, eq=False)
class Pencil:
    """``volume`` V and ``shear`` S of the m unknowns of a body that are free, in the order of their elimination.

    ``normal`` (m, n_s): unit normals of the surface nodes; the ``last`` rows alone have any. ``resultant`` (n_s,) of
    them upwards; ``inertia`` (m,) against one, of a body that nothing else holds.
    """

    body: ElasticBody
    volume: Matrix
    shear: Matrix
    normal: Matrix
    last: int
    resultant: Array
    inertia: Array | None

    @classmethod
    def of(cls, body: ElasticBody) -> Pencil:
        """The order is that of one of its matrices, whose pattern all of them have, with the surface put last."""
        volume, shear = body.stiffness(1.0, 0.0).tocsc(), body.stiffness(0.0, 1.0).tocsc()
        free = np.setdiff1d(np.arange(shear.shape[0]), body.fixed)
        free = free[elimination_order((volume + shear)[free][:, free])]
        normal = normals(body.surface, shear.shape[0])
        touched = np.isin(free, normal.indices[normal.data != 0.0])
        free = np.concatenate([free[~touched], free[touched]])
        return cls(
            body=body,
            volume=volume[free][:, free],
            shear=shear[free][:, free],
            normal=normal[free],
            last=int(touched.sum()),
            resultant=normal.T @ np.tile([0.0, 1.0], normal.shape[0] // 2),
            inertia=None if body.floating is None else body.floating.mass[free] / body.floating.mass.sum(),
        )

    @property
    def loaded(self) -> int:
        """Nodes of the contact zone."""
        return self.body.surface.loaded(self.body.basis.elem.maxdeg)

    def at(self, ratio: float) -> AtRatio:
        """Where shear over bulk modulus is a ratio."""
        bulk, shear = moduli(poisson(ratio))
        response = self._response(bulk, complex(shear, IMAGINARY))
        work = -response[: self.loaded].imag / IMAGINARY
        return AtRatio(poisson(ratio), response.real.copy(), _symmetric(work))

    def _response(self, bulk: float, shear: complex) -> npt.NDArray[np.complex128]:
        """Inward displacement of the surface nodes under unit forces on the contact zone, (n_s, n)."""
        eliminated = Eliminated.of(bulk * self.volume + shear * self.shear, self.last)
        normal = self.normal[-self.last :].toarray()
        response = np.asarray(normal.T @ np.linalg.solve(eliminated.schur, normal[:, : self.loaded]))
        if self.inertia is None:
            return response
        swing = eliminated.solve(self.inertia.astype(complex))  # as if inertia alone pulled; then about the centre
        fall = normal.T @ swing[-self.last :] - 0.5 * (self.inertia @ swing) * self.resultant
        both = np.outer(fall, self.resultant) + np.outer(self.resultant, fall)
        return np.asarray(response - both[:, : self.loaded])


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


def _projected(found: Sequence[AtRatio]) -> tuple[Array, Array]:
    """Work on one another, of unit bulk and of unit shear modulus, of the motions under unit nodal forces."""
    n, count = len(found[0].work), len(found)
    leads = [one.compliance for one in found]
    volume, shear = (np.empty((count, n, count, n)) for _ in range(2))
    for i, first in enumerate(found):
        shear[i, :, i] = first.work
        volume[i, :, i] = (leads[i] - first.shear * first.work) / first.bulk
        for j, second in enumerate(found[:i]):
            determinant = second.bulk * first.shear - first.bulk * second.shear
            volume[i, :, j] = volume[j, :, i] = (first.shear * leads[i] - second.shear * leads[j]) / determinant
            shear[i, :, j] = shear[j, :, i] = (second.bulk * leads[j] - first.bulk * leads[i]) / determinant
    return volume.reshape(count * n, -1), shear.reshape(count * n, -1)


def _independent(work: Array) -> Array:
    """Combinations (all, m) of the motions that do unit work on themselves and none on one another."""
    scale = 1.0 / np.sqrt(np.diag(work))
    energy, directions = eigh(scale[:, None] * work * scale)
    kept = energy > INDEPENDENT * energy[-1]
    return np.asarray(scale[:, None] * directions[:, kept] / np.sqrt(energy[kept]))


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
        """Those of the modes."""
        return self.modes.factorizations

    @property
    def solves(self) -> int:
        """Those of the modes."""
        return self.modes.solves
