"""Large strains of a material that relaxes: Prony branches on the second Piola-Kirchhoff stress.

S(t) = g_inf S0 + sum_i h_i ,  h_i' + h_i/tau_i = g_i S0' ,  S0 = dW/dE at the moduli of a sudden strain

Where Poisson's ratio stays it is the whole of S, as in FEBio's viscoelastic solid; where the bulk modulus stays, the
isochoric part alone (Simo 1987, doi 10.1016/0045-7825(87)90107-1). At small strain it is the network itself. Over a
step S0 changes evenly, so that S is ``at_once`` S0 + H with H known: its potential is at_once W + H:E, its tangent
symmetric.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.solids.base import PointAnswer, Response, State
from fe_contact.solids.finite import Hyperelastic
from lumped.materials import Material, Relaxation

SHEARED = np.array([1.0, 1.0, 1.0, 2.0])  # how often each component of (rr, zz, tt, rz) stands in a double product


@dataclass(frozen=True, eq=False)
class Fading:
    """A Prony series over one step: what is left for ever, and by branch its ``decay`` and ``share``, (k,).

    A state is what the springs would answer at once, (...), and what each branch bears, (k, ...).
    """

    lasting: float
    decay: Array
    share: Array

    @classmethod
    def over(cls, network: Relaxation, length: float) -> Fading:
        """Of a network without a parallel viscosity, in units of its modulus at once; a step of a ``length``, s."""
        rates = length / np.array(network.times)
        shares = np.array(network.moduli) / network.glassy
        return cls(network.relaxed / network.glassy, np.exp(-rates), -shares * np.expm1(-rates) / rates)

    @property
    def at_once(self) -> float:
        """Of a change within the step, what is borne at its end."""
        return self.lasting + float(self.share.sum())

    def held(self, state: State) -> Array:
        """What is borne at the end of the step but for ``at_once`` of the answer there, (...)."""
        before, branches = state
        return np.asarray(np.tensordot(self.decay, branches, 1) - self.share.sum() * before)

    def onwards(self, state: State, now: Array) -> State:
        """At the end of the step, where the springs would answer ``now``, (...)."""
        before, branches = state
        more = (-1, *(1,) * now.ndim)
        return now, self.decay.reshape(more) * branches + self.share.reshape(more) * (now - before)

    def at_rest(self, *shape: int) -> State:
        """Of what nothing has strained yet."""
        return np.zeros(shape), np.zeros((self.decay.size, *shape))


@dataclass(frozen=True, eq=False)
class Relaxing:
    """A ``sudden`` answer that fades; its points remember S0 (4, ...) and the branches' stress (k, 4, ...)."""

    sudden: Hyperelastic
    fading: Fading

    def respond(self, gradient: Array, state: State) -> PointAnswer:
        """See :class:`fe_contact.solids.base.Response`."""
        found = self.sudden.strained(gradient)
        if not np.all(np.isfinite(found.energy)):
            return PointAnswer(found.stress, found.tangent, found.energy, state)
        held, share = self.fading.held(state), self.fading.at_once
        return PointAnswer(
            stress=share * found.stress + _first(held, gradient),
            tangent=_stiffened(share * found.tangent, held),
            energy=share * found.energy + doubled(held, green(gradient)),
            state=self.fading.onwards(state, second(found.stress, gradient)),
            pulls=share * found.pulls,
            drifts=share * found.drifts,
        )


@dataclass(frozen=True, eq=False)
class Volumed:
    """What keeps its ``shape`` for a while, and its ``volume`` for ever."""

    shape: Relaxing
    volume: Hyperelastic

    def respond(self, gradient: Array, state: State) -> PointAnswer:
        """See :class:`fe_contact.solids.base.Response`."""
        shape, volume = self.shape.respond(gradient, state), self.volume.respond(gradient, ())
        return PointAnswer(
            stress=shape.stress + volume.stress,
            tangent=shape.tangent + volume.tangent,
            energy=shape.energy + volume.energy,
            state=shape.state,
            pulls=_sum(shape.pulls, volume.pulls),
            drifts=_sum(shape.drifts, volume.drifts),
        )


def _sum(first: Array | None, other: Array | None) -> Array | None:
    """None where either is."""
    return None if first is None or other is None else first + other


@dataclass(frozen=True, eq=False)
class FadingLaw:
    """A ``sudden`` answer and the ``network`` that all of it fades by, or, where the bulk modulus is ``steady``, what
    changes no volume.
    """

    sudden: Hyperelastic
    network: Relaxation
    steady: bool

    @classmethod
    def of(cls, sudden: Hyperelastic, material: Material) -> FadingLaw:
        """Of a material that answers so at once."""
        steady = material.constant == "bulk"
        return cls(sudden, material.shear if steady else material.young, steady)

    def over(self, fading: Fading) -> Response:
        """In one step."""
        if not self.steady:
            return Relaxing(self.sudden, fading)
        volume = replace(self.sudden, shear=0.0, lame=self._bulk)
        return Volumed(Relaxing(self._with(self.sudden.shear, 0.0), fading), volume)

    @property
    def lasting(self) -> Hyperelastic:
        """What is left for ever."""
        share = self.network.relaxed / self.network.glassy
        return self._with(share * self.sudden.shear, self._bulk if self.steady else share * self._bulk)

    @property
    def branches_nu(self) -> float:
        """Poisson's ratio of what fades."""
        return 0.5 if self.steady else 0.5 * self.sudden.lame / (self.sudden.lame + self.sudden.shear)

    @property
    def _bulk(self) -> float:
        return self.sudden.lame + 2.0 * self.sudden.shear / 3.0

    def _with(self, shear: float, bulk: float) -> Hyperelastic:
        return replace(self.sudden, shear=shear, lame=bulk - 2.0 * shear / 3.0)


def green(gradient: Array) -> Array:
    """Green's strain E of a displacement gradient (5, ...), in components (rr, zz, tt, rz), (4, ...)."""
    rr, rz, zr, zz, tt = gradient
    along = rr + 0.5 * (rr**2 + zr**2), zz + 0.5 * (zz**2 + rz**2), tt + 0.5 * tt**2
    return np.stack([*along, 0.5 * (rz + zr + rr * rz + zr * zz)])


def doubled(first: Array, other: Array) -> Array:
    """Double product of symmetric tensors in components (rr, zz, tt, rz), (...)."""
    return np.asarray(np.einsum("i,i...,i...->...", SHEARED, first, other))


def second(stress: Array, gradient: Array) -> Array:
    """Second Piola-Kirchhoff stress F^-1 P, (4, ...), of the first, (5, ...)."""
    rr, rz, zr, zz, tt = gradient
    volume = (1.0 + rr) * (1.0 + zz) - rz * zr
    radial = (1.0 + zz) * stress[0] - rz * stress[2]
    axial = (1.0 + rr) * stress[3] - zr * stress[1]
    sheared = (1.0 + zz) * stress[1] - rz * stress[3]
    return np.stack([radial / volume, axial / volume, stress[4] / (1.0 + tt), sheared / volume])


def _first(held: Array, gradient: Array) -> Array:
    """F S, (5, ...), of S (4, ...)."""
    rr, rz, zr, zz, tt = gradient
    radial, axial, hoop, sheared = held
    return np.stack([
        (1.0 + rr) * radial + rz * sheared,
        (1.0 + rr) * sheared + rz * axial,
        zr * radial + (1.0 + zz) * sheared,
        zr * sheared + (1.0 + zz) * axial,
        (1.0 + tt) * hoop,
    ])  # fmt: skip


def _stiffened(tangent: Array, held: Array) -> Array:
    """A tangent (5, 5, ...) and what a stress S (4, ...) adds to it, which turns with the body."""
    radial, axial, hoop, sheared = held
    for row in (0, 2):  # rr and zr: along r
        tangent[row, row] += radial
        tangent[row, row + 1] += sheared
        tangent[row + 1, row] += sheared
        tangent[row + 1, row + 1] += axial
    tangent[4, 4] += hoop
    return tangent
