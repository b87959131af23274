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
from types import ModuleType
from typing import NamedTuple

import numpy as np

from fe_contact.bodies.memory import StepLaw, SurfaceMemory, step_law
from fe_contact.bodies.modes import Modes, modes
from fe_contact.bodies.offer import Offer
from fe_contact.bodies.struck import Deformable
from fe_contact.contact import PressedSurface
from fe_contact.elastic_body import ElasticBody
from fe_contact.forms import Array
from fe_contact.kept import kept
from fe_contact.numerics import SCHEMES, Numerics
from fe_contact.operators import SurfaceOperator
from lumped.materials import Relaxation
from lumped.members import get

# Steps between which the ratio of the moduli is looked for, in contact times; it changes little beyond.
SHORTEST, LONGEST = 1e-6, 50.0
SURFACES_KEPT = 4
OFFERS_KEPT = 64  # step lengths whose condensed stiffness is kept: like marches have like steps


class Moduli(NamedTuple):
    """Bulk modulus K(t) and shear modulus G(t), Pa; times a length where forces in plane strain are totals."""

    bulk: Relaxation
    shear: Relaxation


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


@dataclass(frozen=True, eq=False)
class BulkSurface(Deformable):
    """A body before the impact, seen through its surface."""

    modes: Modes
    moduli: Moduli
    breathes: bool = False

    @property
    def operator(self) -> SurfaceOperator:
        """Of the elastic body at one of the ratios: places, weights and scale are those of all."""
        return self.modes.operator

    @property
    def factorizations(self) -> int:
        """One for every ratio of the moduli at which the body was condensed, whatever the steps."""
        return self.modes.ratios

    @property
    def solves(self) -> int:
        """Two a node of the contact zone and ratio: for the compliance, and for the motion of the whole."""
        return 2 * self.modes.ratios * len(self.operator.stiffness)

    def body(self, relaxation: Relaxation, scheme: ModuleType, scale: float) -> BulkBody:
        """The body on its mesh of unit length ``scale``, m; its E*(t) follows from its own moduli."""
        return BulkBody(self.modes, self.moduli, scheme, scale)


@dataclass(frozen=True, eq=False)
class BulkBody:
    """Contract of :class:`fe_contact.bodies.offer.Body`; ``scale``, m, is the mesh's unit of length."""

    modes: Modes
    moduli: Moduli
    scheme: ModuleType
    scale: float

    def at_rest(self) -> BulkMemory:
        """A relaxed, undeformed body."""
        unit = self.scale ** (self.modes.operator.dimension - 2)
        return BulkMemory(
            SurfaceMemory.at_rest(unit * self.modes.volume, self.moduli.bulk, fields=1),
            SurfaceMemory.at_rest(unit * self.modes.shear, self.moduli.shear, fields=1),
        )

    def modulus(self, length: float) -> float:
        """Contact modulus against new strain in a step of a length, s; Pa."""
        return self._law(length).contact_modulus

    def offer(self, memory: BulkMemory, length: float) -> Offer:
        """What contact meets in a step of a length, s."""
        law = self._law(length)
        modulus = law.contact_modulus
        past = self.modes.operator.trace @ (self.modes.shape @ (self._carried(memory, law) / self._now(law)))
        ratio = law.shear.now / law.bulk.now
        return Offer(length, modulus, modulus * past, _pressed(self.modes, ratio))

    def after(self, memory: BulkMemory, offer: Offer, pressure: Array) -> tuple[BulkMemory, float]:
        """The memory after the step under a pressure (q,), and the axis' elastic displacement times modulus."""
        law, operator = self._law(offer.length), self.modes.operator
        load = operator.trace.T @ (operator.weights * pressure)
        amplitude = (self.modes.shape.T @ load - self._carried(memory, law)) / self._now(law)
        volume = memory.volume.advanced(law.bulk, amplitude[None])
        shear = memory.shear.advanced(law.shear, amplitude[None])
        return BulkMemory(volume, shear), float(operator.response[0] @ load)

    def displacement(self, memory: BulkMemory) -> Array:
        """Inward displacement of the surface at the quadrature points, (q,), m."""
        return np.asarray(self.modes.operator.trace @ (self.modes.shape @ memory.shear.strain[0]))

    def stored(self, memory: BulkMemory) -> float:
        """Elastic energy in all springs of both networks, J."""
        return memory.volume.stored(self.moduli.bulk) + memory.shear.stored(self.moduli.shear)

    def dissipated(self, before: BulkMemory, after: BulkMemory, length: float) -> float:
        """Heat of a step in both networks, J."""
        volume = before.volume.dissipated(after.volume, self.moduli.bulk, length)
        return volume + before.shear.dissipated(after.shear, self.moduli.shear, length)

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


def relaxing(body: ElasticBody, moduli: Moduli, numerics: Numerics) -> BulkSurface:
    """A meshed body of a material with these moduli, in an impact with these settings."""
    scheme = get(SCHEMES, numerics.scheme)
    extremes = [share * numerics.contact_time for share in (SHORTEST, LONGEST)]
    laws = [[step_law(modulus, scheme, length).now for modulus in moduli] for length in extremes]
    ratios = sorted(shear / bulk for bulk, shear in laws)
    return _surface(body, moduli, ratios[0], ratios[1])


@kept
def _surface(body: ElasticBody, moduli: Moduli, lowest: float, highest: float) -> BulkSurface:
    return BulkSurface(modes(body, lowest, highest), moduli)
