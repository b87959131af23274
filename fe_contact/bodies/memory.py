"""Memory of a viscoelastic surface, kept on fixed radii: exact where the body's surface knows only E*(t).

Constant Poisson's ratio, or any isotropic homogeneous half-space: the surface displacement u obeys

    elastic displacement of the pressure for unit modulus = E_inf u + sum_k E_k z_k + eta du/dt ,
    dz_k/dt = du/dt - z_k/tau_k ,

at every point of the surface, so that the past is a few numbers a point and the bulk need not be stored.
The same recursion run on the pressure itself gives the pressure each branch carries, hence the energies.

A body whose surface alone remembers, whatever its lengths, has the memory of the contact zone's nodes: displacement u
and the nodal forces f that hold it elastically with unit modulus, so that energies are sums of f u.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import SurfaceOperator
from fe_contact.bodies.offer import Offer, Whole
from fe_contact.contact.problem import PressedSurface
from fe_contact.schemes import galerkin
from fe_contact.schemes.base import MemoryScheme
from lumped.materials import Relaxation

LAWS_KEPT = 1024  # the steps of a march: their energies are counted when it has ended
STENCIL = np.arange(4)[:, None]  # the four values of a cubic
TO_MONOMIALS = np.linalg.inv(np.vander(np.arange(4.0), increasing=True))  # of the cubic through four values


class StepLaw(NamedTuple):
    """Stress of one step: ``now`` x new strain + ``past`` . (old strain, old branches); see :func:`step_law`.

    ``decay``, ``gain`` (k,) move the branches on: z' = decay z + gain (u' - u).
    """

    now: float
    past_strain: float
    past_branches: Array
    decay: Array
    gain: Array


@lru_cache(maxsize=LAWS_KEPT)
def step_law(relaxation: Relaxation, scheme: MemoryScheme, step: float) -> StepLaw:
    """Numbers of one time step, s, of a scheme (see :mod:`fe_contact.schemes`); moduli in Pa."""
    ratios = step / np.asarray(relaxation.times)
    per_increment, of_past = scheme.weights(np.asarray(relaxation.moduli), ratios)
    now = scheme.sample * relaxation.equilibrium + per_increment.sum() + relaxation.viscosity / step
    lost = np.expm1(-ratios)
    return StepLaw(
        now=float(now),
        past_strain=float(relaxation.equilibrium - now),
        past_branches=of_past,
        decay=1.0 + lost,
        gain=-lost / ratios,
    )


class SurfaceMemory(NamedTuple):
    """Displacement and, for its energies, its elastic pressure on fixed radii.

    ``areas`` (r,) m^2 that belong to the radii; ``strain`` (f, r): displacement u, m, and, where f = 2, the
    pressure that holds it elastically with unit modulus, 1; ``branches`` (k, f, r): the same of every branch.
    """

    areas: Array
    strain: Array
    branches: Array

    @classmethod
    def at_rest(cls, areas: Array, relaxation: Relaxation, fields: int) -> SurfaceMemory:
        """A relaxed, undeformed surface that keeps its displacement, or with two fields its pressure too."""
        shape = (fields, areas.size)
        return cls(areas, np.zeros(shape), np.zeros((len(relaxation.moduli), *shape)))

    def carried(self, law: StepLaw) -> Array:
        """Part of the step's stress that the past fixes: modulus x displacement and pressure, (f, r)."""
        of_branches = law.past_branches @ self.branches.reshape(len(self.branches), self.strain.size)
        return law.past_strain * self.strain + of_branches.reshape(self.strain.shape)

    def advanced(self, law: StepLaw, strain: Array) -> SurfaceMemory:
        """State after a step that leads to a strain, (f, r)."""
        branches = law.decay[:, None, None] * self.branches + law.gain[:, None, None] * (strain - self.strain)
        return SurfaceMemory(self.areas, strain, branches)

    def stored(self, relaxation: Relaxation) -> float:
        """Elastic energy in equilibrium spring and branches, J."""
        energies = product(self.areas, self.branches, self.branches)
        equilibrium = relaxation.equilibrium * product(self.areas, self.strain, self.strain)
        return 0.5 * float(equilibrium + np.dot(relaxation.moduli, energies))

    def dissipated(self, later: SurfaceMemory, relaxation: Relaxation, step: float) -> float:
        """Heat of the dashpots over a step in which the displacement changes linearly, J.

        A branch tends to ``share`` of the change; the rest of it fades away.
        """
        area, change = self.areas, later.strain - self.strain
        times = np.asarray(relaxation.times)
        share, x = times / step, step / times
        of_change = product(area, change, change)
        steady, mixed = share**2 * of_change, share * product(area, self.branches, change)
        fading = product(area, self.branches, self.branches) - 2 * mixed + steady
        rates = fading * -np.expm1(-2 * x) / 2 + 2 * (mixed - steady) * -np.expm1(-x) + steady * x
        return float(relaxation.viscosity * of_change / step + np.dot(relaxation.moduli, rates))

    def lost(self, later: SurfaceMemory, relaxation: Relaxation, scheme: MemoryScheme, step: float) -> float:
        """Work of a step's pressure less what is stored and dissipated, J.

        A scheme's stress is not its average over the step, and a mesh knows reciprocity only at its nodes.
        """
        change = later.strain - self.strain
        law = step_law(relaxation, scheme, step)
        taken = mean = law.now * later.strain + self.carried(law)
        if scheme is not galerkin.MEMBER:
            exact = step_law(relaxation, galerkin.MEMBER, step)
            mean = exact.now * later.strain + self.carried(exact)
        return float(self.areas @ (taken[-1] * change[0]) - product(self.areas, change, mean))


def graded(reach: float, points: int) -> Array:
    """Radii up to a reach, m, closer towards the axis: a contact begins as a thousandth of what it becomes."""
    return np.asarray(reach * np.linspace(0.0, 1.0, points) ** 2)


def interpolate(field: Array, reach: float, radii: Array) -> Array:
    """Cubic interpolation, in the root of the radius, of a field known at :func:`graded` radii, at radii up to there.

    A straight line between the points would roughen a pressure, which is nearly the field's second
    derivative, by more than the contact problem's own error.
    """
    position = np.sqrt(radii / reach) * (field.size - 1)
    first = position.astype(np.intp)
    first -= 1
    np.maximum(first, 0, out=first)
    np.minimum(first, field.size - 4, out=first)
    x = position - first
    constant, slope, bend, twist = TO_MONOMIALS @ field.take(first + STENCIL)
    return np.asarray(constant + x * (slope + x * (bend + x * twist)))


def area_weights(radii: Array) -> Array:
    """Trapezoidal weights of an axisymmetric surface integral, m^2."""
    spacing = np.diff(radii, prepend=radii[0], append=radii[-1])
    return np.asarray(np.pi * radii * (spacing[1:] + spacing[:-1]))


def product(weights: Array, first: Array, second: Array) -> Array:
    """Work of one field's pressure on the other's displacement over the surface (symmetric), m^3 x Pa/Pa.

    Fields (..., f, r), works (...). Where pressure is displacement times the weight, one field is both.
    """
    if first is second or first.shape[-2] == 1:
        return np.asarray((first[..., 0, :] * second[..., -1, :]) @ weights)
    return np.asarray(0.5 * (first[..., 0, :] * second[..., -1, :] + first[..., -1, :] * second[..., 0, :]) @ weights)


class OneNetwork:
    """Steps by a ``scheme``, and their energies, of what remembers by its surface alone, of one ``relaxation``."""

    relaxation: Relaxation
    scheme: MemoryScheme

    def law(self, length: float) -> StepLaw:
        """Numbers of a step of a length, s."""
        return step_law(self.relaxation, self.scheme, length)

    def stored(self, memory: SurfaceMemory) -> float:
        """Elastic energy in all springs, J."""
        return memory.stored(self.relaxation)

    def heat_and_loss(self, before: SurfaceMemory, after: SurfaceMemory, length: float) -> tuple[float, float]:
        """Heat of a step, J, and of the work in it what the scheme leaves unaccounted for, J."""
        lost = before.lost(after, self.relaxation, self.scheme, length)
        return before.dissipated(after, self.relaxation, length), lost


@dataclass(frozen=True, eq=False)
class SurfaceBody(OneNetwork, Whole):
    """Contracts of :class:`fe_contact.bodies.offer.Body` and ``Half``; ``scale``, m, is the mesh's unit of length.

    ``share``: its stiffness over that of its operator.
    """

    operator: SurfaceOperator
    pressed: PressedSurface
    relaxation: Relaxation
    scheme: MemoryScheme
    scale: float
    share: float = 1.0

    def at_rest(self) -> SurfaceMemory:
        """A relaxed, undeformed body."""
        nodes = np.ones(len(self.operator.stiffness))
        return SurfaceMemory.at_rest(nodes, self.relaxation, fields=2)

    def recalled(self, memory: SurfaceMemory, length: float) -> Offer:
        """What its past makes of a step of a length, s, at the nodes."""
        law = self.law(length)
        return Offer(length, law.now, memory.carried(law)[0], self.pressed)

    def pushed(self, memory: SurfaceMemory, length: float, load: Array) -> SurfaceMemory:
        """The memory after a step of a length, s, under forces at the nodes, (n,)."""
        law = self.law(length)
        displacement = self.operator.compliance @ load / self.share
        force = load * self.scale ** (self.operator.dimension - 2)
        return memory.advanced(law, (np.array([displacement, force]) - memory.carried(law)) / law.now)

    def sunk(self, memory: SurfaceMemory) -> Array:
        """Inward displacement of the nodes, (n,), m."""
        return np.asarray(memory.strain[0])
