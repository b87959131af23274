"""A body whose surface alone remembers: constant Poisson's ratio, whatever its lengths.

The memory is that of the contact zone's nodes: displacement u and the nodal forces f that hold it elastically with
unit modulus, so that energies are sums of f u.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import SurfaceOperator
from fe_contact.assembly.pressed_surface import PressedSurface
from fe_contact.bodies.memory import StepLaw, SurfaceMemory, step_law
from fe_contact.bodies.offer import Offer, Recalled
from fe_contact.schemes.base import MemoryScheme
from lumped.materials import Relaxation


@dataclass(frozen=True, eq=False)
class SurfaceBody:
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

    def offer(self, memory: SurfaceMemory, length: float) -> Offer:
        """What contact meets in a step of a length, s."""
        now, past, _ = self.recalled(memory, length)
        return Offer(length, now, self.operator.trace @ past, self.pressed)

    def recalled(self, memory: SurfaceMemory, length: float) -> Recalled:
        """The same at the nodes."""
        law = self._law(length)
        return Recalled(law.now, memory.carried(law)[0], self.pressed.stiffness)

    def after(self, memory: SurfaceMemory, offer: Offer, pressure: Array) -> tuple[SurfaceMemory, float]:
        """The memory after the step under a pressure (q,), and the axis' elastic displacement times modulus."""
        operator = self.operator
        load = operator.trace.T @ (operator.weights * pressure)
        return self.pushed(memory, offer.length, load), float(operator.compliance[0] @ load)

    def pushed(self, memory: SurfaceMemory, length: float, load: Array) -> SurfaceMemory:
        """The memory after a step of a length, s, under forces at the nodes, (n,)."""
        law = self._law(length)
        displacement = self.operator.compliance @ load / self.share
        force = load * self.scale ** (self.operator.dimension - 2)
        return memory.advanced(law, (np.array([displacement, force]) - memory.carried(law)) / law.now)

    def displacement(self, memory: SurfaceMemory) -> Array:
        """Inward displacement of the surface at the quadrature points, (q,), m."""
        return np.asarray(self.operator.trace @ self.sunk(memory))

    def sunk(self, memory: SurfaceMemory) -> Array:
        """The same of the nodes, (n,), m."""
        return np.asarray(memory.strain[0])

    def stored(self, memory: SurfaceMemory) -> float:
        """Elastic energy in all springs, J."""
        return memory.stored(self.relaxation)

    def dissipated(self, before: SurfaceMemory, after: SurfaceMemory, length: float) -> float:
        """Heat of a step, J."""
        return before.dissipated(after, self.relaxation, length)

    def lost(self, before: SurfaceMemory, after: SurfaceMemory, length: float) -> float:
        """Of the work in a step, what the scheme leaves unaccounted for, J."""
        return before.lost(after, self.relaxation, self.scheme, length)

    def _law(self, length: float) -> StepLaw:
        return step_law(self.relaxation, self.scheme, length)
