"""What contact sees of a body: its surface on a mesh, what it offers for one time step, what it makes of a pressure."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeAlias

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import SurfaceOperator
from fe_contact.contact.problem import PressedSurface

Memory: TypeAlias = Any  # what a body carries from step to step, each kind its own


class Offer(NamedTuple):
    """A step of a ``length``, s, as contact sees it: displacement x ``now`` = unit compliance x forces - ``past``.

    ``now``: contact modulus of the step, Pa; ``past`` (q,) at the quadrature points, or (n,) at the contact zone's own
    nodes; ``surface``: for unit modulus.
    """

    length: float
    now: float
    past: Array
    surface: PressedSurface


class Remembering(Protocol):
    """What carries a memory from step to step, which is its own affair, and passed in and out."""

    def at_rest(self) -> Memory:
        """Memory of a relaxed, undeformed body."""

    def stored(self, memory: Memory) -> float:
        """Elastic energy in all springs, J."""

    def heat_and_loss(self, before: Memory, after: Memory, length: float) -> tuple[float, float]:
        """Heat of a step, J, and of the work in it what the scheme leaves unaccounted for, J."""


class Half(Remembering, Protocol):
    """One of the bodies under a common pressure, by the nodes of its own contact zone."""

    def recalled(self, memory: Memory, length: float) -> Offer:
        """What its past makes of a step of a length, s, at the nodes."""

    def pushed(self, memory: Memory, length: float, load: Array) -> Memory:
        """The memory after a step of a length, s, under forces at the nodes, (n,)."""

    def sunk(self, memory: Memory) -> Array:
        """Inward displacement of the nodes, (n,), m."""


class Body(Remembering, Protocol):
    """A deformable body, by the quadrature points of its contact zone."""

    def offer(self, memory: Memory, length: float) -> Offer:
        """What contact meets in a step of a length, s."""

    def after(self, memory: Memory, offer: Offer, pressure: Array) -> tuple[Memory, float]:
        """The memory after the step under a pressure (q,), and the axis' elastic displacement times modulus."""

    def displacement(self, memory: Memory) -> Array:
        """Inward displacement of the surface at the quadrature points, (q,), m."""


class Whole(Half, Protocol):
    """A half that may be all there is: what its nodes know, by the points of its ``operator``."""

    if TYPE_CHECKING:  # members have it as a field or as a property

        @property
        def operator(self) -> SurfaceOperator: ...

    def offer(self, memory: Memory, length: float) -> Offer:
        """What contact meets in a step of a length, s."""
        at_nodes = self.recalled(memory, length)
        return at_nodes._replace(past=self.operator.trace @ at_nodes.past)

    def after(self, memory: Memory, offer: Offer, pressure: Array) -> tuple[Memory, float]:
        """The memory after the step under a pressure (q,), and the axis' elastic displacement times modulus."""
        operator = self.operator
        load = operator.trace.T @ (operator.weights * pressure)
        return self.pushed(memory, offer.length, load), float(operator.compliance[0] @ load)

    def displacement(self, memory: Memory) -> Array:
        """Inward displacement of the surface at the quadrature points, (q,), m."""
        return np.asarray(self.operator.trace @ self.sunk(memory))
