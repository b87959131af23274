"""What contact sees of a body: its surface on a mesh, what it offers for one time step, what it makes of a pressure."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol, TypeAlias

from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import SurfaceOperator
from fe_contact.assembly.pressed_surface import PressedSurface
from fe_contact.contact.problem import ContactProblem
from fe_contact.schemes.base import MemoryScheme
from lumped.materials import Relaxation

Memory: TypeAlias = Any  # what a body carries from step to step, each kind its own


class Offer(NamedTuple):
    """A step of a ``length``, s, as contact sees it: displacement x ``now`` = unit compliance x forces - ``past``.

    ``now``: contact modulus of the step, Pa; ``past`` (q,) at the quadrature points; ``surface``: for unit modulus.
    """

    length: float
    now: float
    past: Array
    surface: PressedSurface


class Recalled(NamedTuple):
    """A step at the contact zone's own n nodes: displacement x ``now`` = unit compliance x forces - ``past`` (n,).

    ``now``: contact modulus of the step, Pa; ``stiffness``: inverse of the unit compliance, (n, n).
    """

    now: float
    past: Array
    stiffness: Array


class Half(Protocol):
    """One of the bodies under a common pressure, by the nodes of its own contact zone."""

    def at_rest(self) -> Memory:
        """Memory of a relaxed, undeformed body."""

    def recalled(self, memory: Memory, length: float) -> Recalled:
        """What its past makes of a step of a length, s."""

    def pushed(self, memory: Memory, length: float, load: Array) -> Memory:
        """The memory after a step of a length, s, under forces at the nodes, (n,)."""

    def sunk(self, memory: Memory) -> Array:
        """Inward displacement of the nodes, (n,), m."""

    def stored(self, memory: Memory) -> float:
        """Elastic energy in all springs, J."""

    def dissipated(self, before: Memory, after: Memory, length: float) -> float:
        """Heat of a step, J."""

    def lost(self, before: Memory, after: Memory, length: float) -> float:
        """Of the work in a step, what the scheme leaves unaccounted for, J."""


class Body(Protocol):
    """A deformable body; its memory is its own affair, and passed in and out."""

    def at_rest(self) -> Memory:
        """Memory of a relaxed, undeformed body."""

    def offer(self, memory: Memory, length: float) -> Offer:
        """What contact meets in a step of a length, s."""

    def after(self, memory: Memory, offer: Offer, pressure: Array) -> tuple[Memory, float]:
        """The memory after the step under a pressure (q,), and the axis' elastic displacement times modulus."""

    def displacement(self, memory: Memory) -> Array:
        """Inward displacement of the surface at the quadrature points, (q,), m."""

    def stored(self, memory: Memory) -> float:
        """Elastic energy in all springs, J."""

    def dissipated(self, before: Memory, after: Memory, length: float) -> float:
        """Heat of a step, J."""

    def lost(self, before: Memory, after: Memory, length: float) -> float:
        """Of the work in a step, what the scheme leaves unaccounted for, J."""


class Meshed(Protocol):
    """The surface of one elastic body on its mesh; ``operator``: its places, weights and scale."""

    @property
    def operator(self) -> SurfaceOperator: ...


class Staying(Meshed, Protocol):
    """One on a mesh that stays while the contact grows."""

    @property
    def rim(self) -> float | None:
        """Where all contacts end, m, if the body is loaded no farther."""

    def body(self, relaxation: Relaxation, scheme: MemoryScheme, scale: float) -> Body:
        """The body with a contact modulus E*(t), Pa, marched by a scheme, on a mesh whose unit is ``scale``, m."""

    def unit(self, contact_radius: float) -> float:
        """The mesh's unit of length, m, where contacts up to this radius, m, are expected."""

    def places(self, unit: float) -> Array:
        """Distance of the quadrature points from the first touch as the striker's profile counts it, m; (q,)."""


class Breathing(Meshed, Protocol):
    """One on a mesh for contact radius 1 and E* = 1, which is scaled to the contact of each instant."""

    @property
    def pressed(self) -> PressedSurface:
        """What contact knows of it."""

    def problem(self, overlap: Array, penalty: float, yielding: float | Array) -> ContactProblem:
        """Contact problem on the unit mesh, of free overlaps times modulus (q,)."""

    def response(self, pressure: Array) -> Array:
        """Displacement times modulus of all surface nodes, (n_s,), under a unit-mesh pressure (q,)."""

    def sample(self, nodal: Array, radii: Array) -> Array:
        """A nodal surface field at increasing radii in units of the contact radius."""
