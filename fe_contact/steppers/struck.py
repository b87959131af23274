"""What is struck: what the march and its error budget ask of it, and what all bodies with a mesh share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

from fe_contact.assembly.forms import Array
from fe_contact.bodies.condensed import Condensed
from fe_contact.bodies.offer import Body
from fe_contact.schemes.base import MemoryScheme
from fe_contact.settings import Numerics
from fe_contact.steppers.fixed_stepping import FixedStepper
from fe_contact.steppers.march import Snapshot, Strike
from fe_contact.steppers.steps import Stepping
from lumped.materials import Relaxation


class Struck(Protocol):
    """What is struck, with one setting of everything: ``breathes`` where its mesh follows the contact, ``recovers``
    where one surface alone remembers, so that what nothing presses is known at any time.

    ``factorizations`` and back-substitutions, ``solves``, that it took; unknowns of its meshes.
    """

    @property
    def breathes(self) -> bool: ...

    @property
    def recovers(self) -> bool: ...

    @property
    def factorizations(self) -> int: ...

    @property
    def solves(self) -> int: ...

    @property
    def degrees_of_freedom(self) -> int: ...

    def stepper(self, strike: Strike, numerics: Numerics, expected: Sequence[float] | Array) -> Stepping:
        """What takes its time steps: ``expected`` radii, m, of a like march."""

    def felt(self, snapshot: Snapshot) -> tuple[Array, Array]:
        """Places on its surface, m, and the pressure there that it feels in a step, Pa, each (n,)."""


class Deformable(Condensed):
    """A struck body before the impact: ``operator`` of one elastic body on its mesh, for places, weights and scale.

    The contract of :class:`Struck`, of which only what differs has to be said.
    """

    if TYPE_CHECKING:  # members have it as a field or as a property

        @property
        def breathes(self) -> bool: ...

    @property
    def rim(self) -> float | None:
        """Where all contacts end, m, if the body is loaded no farther."""
        return None

    def body(self, relaxation: Relaxation, scheme: MemoryScheme, scale: float) -> Body:
        """The body with a contact modulus E*(t), Pa, marched by a scheme, on a mesh whose unit is ``scale``, m."""
        raise NotImplementedError

    @property
    def recovers(self) -> bool:
        """Here it does."""
        return True

    @property
    def degrees_of_freedom(self) -> int:
        """Unknowns of the one mesh."""
        return self.operator.degrees_of_freedom

    def unit(self, contact_radius: float) -> float:
        """The mesh's unit of length, m, where contacts up to this radius, m, are expected."""
        return contact_radius

    def places(self, unit: float) -> Array:
        """Distance of the quadrature points from the first touch as the striker's profile counts it, m; (q,)."""
        return unit * self.operator.points

    def stepper(self, strike: Strike, numerics: Numerics, expected: Sequence[float] | Array) -> Stepping:
        """Steps on the mesh that stays, for which no radius has to be expected."""
        return FixedStepper(strike, self, numerics)

    def felt(self, snapshot: Snapshot) -> tuple[Array, Array]:
        """At the nodes, without the roughness that the shape functions do not see."""
        operator = self.operator
        nodes = float(snapshot.radii[0] / operator.points[0]) * operator.nodes[: operator.trace.shape[1]]
        return nodes, operator.projected(snapshot.pressure)
