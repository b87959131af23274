"""Round bodies of their true size under one pressure: their displacements add, and each remembers its own past.

With a constant Poisson's ratio the surface of each obeys the law of :mod:`fe_contact.bodies.memory`, so that in a
step one over the modulus of both is the sum of one over theirs.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from types import ModuleType

import numpy as np
from scipy.linalg import block_diag

from fe_contact.bodies.memory import StepLaw, SurfaceMemory, step_law
from fe_contact.bodies.offer import Offer
from fe_contact.bodies.struck import Deformable
from fe_contact.contact import PressedSurface
from fe_contact.forms import Array
from fe_contact.march import Snapshot
from fe_contact.operators import SurfaceOperator
from lumped.materials import Relaxation

Memory = tuple[SurfaceMemory, ...]


@dataclass(frozen=True, eq=False)
class Side:
    """One body: its ``operator``, its own contact modulus ``relaxation``, Pa (times a length in plane strain).

    ``trace`` (q, n): displacement at the common points from that of its n nodes in the contact zone; ``share``: its
    stiffness over that of its operator, in units of the body that has the points.
    """

    operator: SurfaceOperator
    relaxation: Relaxation
    trace: Array
    share: float = 1.0

    @property
    def stiffness(self) -> Array:
        """Condensed, in units of the body that has the points, (n, n)."""
        return self.share * self.operator.stiffness

    @cached_property
    def compliance(self) -> Array:
        """Displacement times modulus of its nodes under unit nodal forces, (n, n)."""
        return self.operator.compliance / self.share

    @cached_property
    def at_points(self) -> Array:
        """Displacement times modulus of the common points under unit forces there, (q, q), symmetric."""
        found = self.trace @ np.linalg.solve(self.stiffness, self.trace.T)
        return np.asarray((found + found.T) / 2)


@dataclass(frozen=True, eq=False)
class Stacked(Deformable):
    """One body or two before the impact; ``operator`` of the one that has the points, angles on its ``radius``, m."""

    operator: SurfaceOperator
    sides: tuple[Side, ...]
    radius: float
    breathes: bool = False

    @property
    def factorizations(self) -> int:
        """One a mesh."""
        return len(self.sides)

    @property
    def solves(self) -> int:
        """One a node of every contact zone."""
        return sum(len(side.operator.stiffness) for side in self.sides)

    @property
    def degrees_of_freedom(self) -> int:
        """Unknowns of all meshes."""
        return sum(side.operator.degrees_of_freedom for side in self.sides)

    def unit(self, contact_radius: float) -> float:
        """Its radius, m, whatever contacts are expected."""
        return self.radius

    def places(self, unit: float) -> Array:
        """From the line of motion, m."""
        return unit * np.sin(self.operator.points)

    def body(self, relaxation: Relaxation, scheme: ModuleType, scale: float) -> StackedBody:
        """The bodies marched by a scheme; each has a modulus of its own, ``relaxation`` is that of all of them."""
        return StackedBody(self.operator, self.sides, scheme, scale)

    def felt(self, snapshot: Snapshot) -> tuple[Array, Array]:
        """At the nodes, without the roughness that the shape functions do not see."""
        nodes = self.operator.nodes[: self.operator.trace.shape[1]]
        return self.radius * np.sin(nodes), self.operator.projected(snapshot.pressure)


@dataclass(frozen=True, eq=False)
class StackedBody:
    """The contract of :class:`fe_contact.bodies.offer.Body`; the memory is one surface's for each side."""

    operator: SurfaceOperator
    sides: tuple[Side, ...]
    scheme: ModuleType
    scale: float

    def at_rest(self) -> Memory:
        """Relaxed, undeformed surfaces."""
        return tuple(
            SurfaceMemory.at_rest(np.ones(side.trace.shape[1]), side.relaxation, fields=2) for side in self.sides
        )

    def modulus(self, length: float) -> float:
        """Contact modulus of all against new strain in a step of a length, s; Pa."""
        return _together(self._laws(length))

    def offer(self, memory: Memory, length: float) -> Offer:
        """What contact meets in a step of a length, s."""
        laws = self._laws(length)
        now = _together(laws)
        past = np.zeros_like(self.operator.points)
        for side, own, law in zip(self.sides, memory, laws, strict=True):
            past += now / law.now * (side.trace @ own.carried(law)[0])
        return Offer(length, now, past, self._pressed(tuple(law.now / now for law in laws)))

    def after(self, memory: Memory, offer: Offer, pressure: Array) -> tuple[Memory, float]:
        """The memories after the step under a pressure (q,), and the first axis' elastic displacement times modulus."""
        answers = [self._answer(side, pressure) for side in self.sides]
        laws = self._laws(offer.length)
        moved = tuple(
            own.advanced(law, (answer - own.carried(law)) / law.now)
            for own, law, answer in zip(memory, laws, answers, strict=True)
        )
        middle = int(np.abs(self.operator.nodes[: self.operator.trace.shape[1]]).argmin())
        return moved, float(answers[0][0, middle])

    def displacement(self, memory: Memory) -> Array:
        """Inward displacement of all surfaces at the quadrature points, (q,), m."""
        return np.asarray(sum(side.trace @ own.strain[0] for side, own in zip(self.sides, memory, strict=True)))

    def stored(self, memory: Memory) -> float:
        """Elastic energy in all springs, J."""
        return sum(own.stored(side.relaxation) for side, own in zip(self.sides, memory, strict=True))

    def dissipated(self, before: Memory, after: Memory, length: float) -> float:
        """Heat of a step, J."""
        sides = zip(self.sides, before, after, strict=True)
        return sum(first.dissipated(then, side.relaxation, length) for side, first, then in sides)

    def _laws(self, length: float) -> tuple[StepLaw, ...]:
        return tuple(step_law(side.relaxation, self.scheme, length) for side in self.sides)

    def _answer(self, side: Side, pressure: Array) -> Array:
        """Displacement x modulus of a side's nodes, m, and the forces that hold it elastically; (2, n)."""
        load = side.trace.T @ (self.operator.weights * pressure)
        return np.array([side.compliance @ load, load * self.scale ** (self.operator.dimension - 2)])

    def _pressed(self, weights: tuple[float, ...]) -> PressedSurface:
        """All sides, each with its modulus over the common one."""
        return stacked(self.operator, self.sides, weights) if len(self.sides) > 1 else self._alone

    @cached_property
    def _alone(self) -> PressedSurface:
        """The one side, whose modulus is the common one."""
        return stacked(self.operator, self.sides, (1.0,))


def stacked(operator: SurfaceOperator, sides: tuple[Side, ...], weights: tuple[float, ...]) -> PressedSurface:
    """The sides under one pressure at the operator's points; ``weights``: modulus of each over the common one."""
    blocks = (weight * side.stiffness for side, weight in zip(sides, weights, strict=True))
    trace = np.hstack([side.trace for side in sides])
    yields = sum(side.at_points / weight for side, weight in zip(sides, weights, strict=True))
    compliance = np.asarray(yields) if len(sides) > 1 else None
    return PressedSurface(block_diag(*blocks), trace, operator.weights, recurring=False, compliance=compliance)


def _together(laws: tuple[StepLaw, ...]) -> float:
    return 1.0 / sum(1.0 / law.now for law in laws)
