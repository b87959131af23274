"""A body whose volume and shape relax apart, as with a constant bulk modulus: the memory lies in its bulk.

Of the modes in which the two do no work on one another (:mod:`fe_contact.bodies.modes`) each is a pair of networks side
by side, K(t) on its change of volume and G(t) on its change of shape,

    force of the pressure on the mode = volume K * q + shear G * q ,

* the hereditary integral over the amplitude q, m. A step of any length is one division a mode: what few factorisations
there are made the modes. Beyond the mesh lies the same material, whose stiffness is in the modes too: it relaxes alike.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import SurfaceOperator
from fe_contact.bodies.memory import StepLaw, SurfaceMemory, step_law
from fe_contact.bodies.modes import Modes
from fe_contact.bodies.offer import Offer, Whole
from fe_contact.contact.problem import PressedSurface
from fe_contact.schemes.base import MemoryScheme
from lumped.materials import Material, Relaxation

SURFACES_KEPT = 4  # work: memory, bodies whose pressed surface is kept
OFFERS_KEPT = 64  # step lengths whose condensed stiffness is kept: like marches have like steps


class Moduli(NamedTuple):
    """Bulk modulus K(t) and shear modulus G(t), Pa; times a length where forces in plane strain are totals."""

    bulk: Relaxation
    shear: Relaxation

    @classmethod
    def of(cls, material: Material, length: float) -> Moduli:
        """Of a material of constant bulk modulus; ``length``, m, over which forces are totals, else 1."""
        return cls(Relaxation(material.bulk).scaled(length), material.shear.scaled(length))


class BulkMemory(NamedTuple):
    """Amplitudes of the modes, m, as each network remembers them: the weights are the modes' stiffness per modulus."""

    volume: SurfaceMemory
    shear: SurfaceMemory


class BulkLaw(NamedTuple):
    """One time step of both networks."""

    bulk: StepLaw
    shear: StepLaw

    @property
    def contact_modulus(self) -> float:
        """E* of the step, 4 G (3 K + G)/(3 K + 4 G), Pa."""
        bulk, shear = self.bulk.now, self.shear.now
        return float(4.0 * shear * (3.0 * bulk + shear) / (3.0 * bulk + 4.0 * shear))

    @property
    def ratio(self) -> float:
        """Shear over bulk modulus."""
        return self.shear.now / self.bulk.now


@dataclass(frozen=True, eq=False)
class BulkBody(Whole):
    """Contracts of :class:`fe_contact.bodies.offer.Body` and ``Half``; ``scale``, m, is the mesh's unit of length."""

    modes: Modes
    moduli: Moduli
    scheme: MemoryScheme
    scale: float

    def at_rest(self) -> BulkMemory:
        """A relaxed, undeformed body."""
        unit = self.scale ** (self.modes.operator.dimension - 2)
        return BulkMemory(
            SurfaceMemory.at_rest(unit * self.modes.volume, self.moduli.bulk, fields=1),
            SurfaceMemory.at_rest(unit * self.modes.shear, self.moduli.shear, fields=1),
        )

    @property
    def operator(self) -> SurfaceOperator:
        """Of the elastic body at one of the ratios: points and weights are those of all."""
        return self.modes.operator

    def recalled(self, memory: BulkMemory, length: float) -> Offer:
        """What its past makes of a step of a length, s, at the nodes."""
        law = self._law(length)
        past = law.contact_modulus * (self.modes.shape @ (self._carried(memory, law) / self._now(law)))
        return Offer(length, law.contact_modulus, past, _pressed(self.modes, law.ratio))

    def pushed(self, memory: BulkMemory, length: float, load: Array) -> BulkMemory:
        """The memory after a step of a length, s, under forces at the nodes, (n,)."""
        law = self._law(length)
        amplitude = ((self.modes.shape.T @ load - self._carried(memory, law)) / self._now(law))[None]
        return BulkMemory(memory.volume.advanced(law.bulk, amplitude), memory.shear.advanced(law.shear, amplitude))

    def sunk(self, memory: BulkMemory) -> Array:
        """Inward displacement of the nodes, (n,), m."""
        return np.asarray(self.modes.shape @ memory.shear.strain[0])

    def stored(self, memory: BulkMemory) -> float:
        """Elastic energy in all springs of both networks, J."""
        return memory.volume.stored(self.moduli.bulk) + memory.shear.stored(self.moduli.shear)

    def heat_and_loss(self, before: BulkMemory, after: BulkMemory, length: float) -> tuple[float, float]:
        """Heat of a step in both networks, J, and of the work on them what the scheme leaves unaccounted for, J."""
        pairs = list(zip(before, after, self.moduli, strict=True))
        heat = sum(early.dissipated(late, modulus, length) for early, late, modulus in pairs)
        return heat, sum(early.lost(late, modulus, self.scheme, length) for early, late, modulus in pairs)

    def _law(self, length: float) -> BulkLaw:
        return BulkLaw(*(step_law(modulus, self.scheme, length) for modulus in self.moduli))

    def _now(self, law: BulkLaw) -> Array:
        """Stiffness of the modes against new strain, (m,), Pa."""
        return self.modes.volume * law.bulk.now + self.modes.shear * law.shear.now

    def _carried(self, memory: BulkMemory, law: BulkLaw) -> Array:
        """Force on the modes, (m,), that the past fixes."""
        volume, shear = memory.volume.carried(law.bulk)[0], memory.shear.carried(law.shear)[0]
        return np.asarray(self.modes.volume * volume + self.modes.shear * shear)


@lru_cache(maxsize=SURFACES_KEPT)
def _points(modes: Modes) -> PressedSurface:
    """The contact zone on one elastic body."""
    operator = modes.operator
    return PressedSurface(operator.stiffness, operator.trace, operator.weights, recurring=False)


@lru_cache(maxsize=OFFERS_KEPT)
def _pressed(modes: Modes, ratio: float) -> PressedSurface:
    """What contact knows of the body in a step, for unit contact modulus."""
    return _points(modes).stiffened(modes.stiffness(ratio))
