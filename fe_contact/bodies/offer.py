"""What a body on a mesh that stays offers contact for one time step, and what it makes of the pressure found."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

from fe_contact.forms import Array
from fe_contact.pressed_surface import PressedSurface


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

    def at_rest(self) -> Any:
        """Memory of a relaxed, undeformed body."""

    def recalled(self, memory: Any, length: float) -> Recalled:
        """What its past makes of a step of a length, s."""

    def pushed(self, memory: Any, length: float, load: Array) -> Any:
        """The memory after a step of a length, s, under forces at the nodes, (n,)."""

    def sunk(self, memory: Any) -> Array:
        """Inward displacement of the nodes, (n,), m."""

    def stored(self, memory: Any) -> float:
        """Elastic energy in all springs, J."""

    def dissipated(self, before: Any, after: Any, length: float) -> float:
        """Heat of a step, J."""

    def lost(self, before: Any, after: Any, length: float) -> float:
        """Of the work in a step, what the scheme leaves unaccounted for, J."""


class Body(Protocol):
    """A deformable body; its memory is its own affair, and passed in and out."""

    def at_rest(self) -> Any:
        """Memory of a relaxed, undeformed body."""

    def offer(self, memory: Any, length: float) -> Offer:
        """What contact meets in a step of a length, s."""

    def after(self, memory: Any, offer: Offer, pressure: Array) -> tuple[Any, float]:
        """The memory after the step under a pressure (q,), and the axis' elastic displacement times modulus."""

    def displacement(self, memory: Any) -> Array:
        """Inward displacement of the surface at the quadrature points, (q,), m."""

    def stored(self, memory: Any) -> float:
        """Elastic energy in all springs, J."""

    def dissipated(self, before: Any, after: Any, length: float) -> float:
        """Heat of a step, J."""

    def lost(self, before: Any, after: Any, length: float) -> float:
        """Of the work in a step, what the scheme leaves unaccounted for, J."""
