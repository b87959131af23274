"""Bodies under one pressure at common points: their displacements add, and each remembers its own past.

Each has nodes and a memory of its own. With a constant Poisson's ratio its surface obeys the law of
:mod:`fe_contact.bodies.memory`; where volume and shape relax apart its bulk does that of
:mod:`fe_contact.bodies.bulk_memory`. In a step one over the modulus of all is the sum of one over theirs.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg import block_diag

from fe_contact.assembly.cache import Recipe, cached_surface
from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import ElasticBody, SurfaceOperator, operator_of
from fe_contact.bodies.bulk_memory import BulkBody, Moduli
from fe_contact.bodies.memory import SurfaceBody
from fe_contact.bodies.modes import ByModes, Condensed, Modes, modes
from fe_contact.bodies.offer import Half, Offer
from fe_contact.contact.problem import PressedSurface
from fe_contact.schemes.base import MemoryScheme
from fe_contact.steppers.bulk_surface import Pace
from fe_contact.steppers.steps import Snapshot
from fe_contact.steppers.struck import Deformable
from lumped.materials import Material, Relaxation
from lumped.shapes import Shape


@dataclass(frozen=True, eq=False)
class BodySide(Condensed):
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
    def at_points(self) -> Array:
        """Displacement times modulus of the common points under unit forces there, (q, q), symmetric."""
        found = self.trace @ np.linalg.solve(self.stiffness, self.trace.T)
        return np.asarray((found + found.T) / 2)

    @property
    def steady(self) -> bool:
        """Whether its compliance is the same, but for the modulus, in every step."""
        return True

    def half(self, scheme: MemoryScheme, scale: float) -> Half:
        """The body, whose surface remembers; ``scale``, m, is the common unit."""
        operator = self.operator
        pressed = PressedSurface(self.stiffness, operator.trace, operator.weights, recurring=False)
        return SurfaceBody(operator, pressed, self.relaxation, scheme, scale, self.share)


@dataclass(frozen=True, eq=False)
class BulkSide(ByModes, BodySide):
    """The same of a body whose bulk remembers; ``operator`` is one of its ``modes``', which count with the share."""

    modes: Modes = field(kw_only=True)
    moduli: Moduli = field(kw_only=True)

    @property
    def steady(self) -> bool:
        """No: its Poisson's ratio relaxes."""
        return False

    def half(self, scheme: MemoryScheme, scale: float) -> Half:
        """The body, whose bulk remembers; ``scale``, m, is the common unit."""
        return BulkBody(self._stiffer, self.moduli, scheme, scale)

    @cached_property
    def _stiffer(self) -> Modes:
        return self.modes.stiffer(self.share)


def side_of(body: Recipe[ElasticBody], material: Material, shape: Shape, pace: Pace | None) -> BodySide:
    """A meshed body under a pressure at its own points; ``pace`` of an impact in which it may relax by its bulk."""
    relaxation = shape.modulus(material).scaled(shape.total)
    if pace is not None and material.constant == "bulk" and not material.young.is_elastic:
        moduli = Moduli.of(material, shape.total)
        found = modes(body, *pace.ratios(moduli))
        return BulkSide(found.operator, relaxation, found.operator.trace, modes=found, moduli=moduli)
    operator = _operator(body, material.nu)
    return BodySide(operator, relaxation, operator.trace)


_operator = cached_surface(operator_of)


def stacked(operator: SurfaceOperator, sides: tuple[BodySide, ...], weights: tuple[float, ...]) -> PressedSurface:
    """The sides under one pressure at the operator's points; ``weights``: modulus of each over the common one."""
    blocks = (weight * side.stiffness for side, weight in zip(sides, weights, strict=True))
    trace = np.hstack([side.trace for side in sides])
    shares = [side.at_points / weight for side, weight in zip(sides, weights, strict=True)]
    return PressedSurface(
        block_diag(*blocks),
        trace,
        operator.weights,
        recurring=False,
        compliance=np.sum(shares, axis=0),
        carriers=carriers(operator, sides),
    )


def carriers(operator: SurfaceOperator, sides: tuple[BodySide, ...]) -> Array | None:
    """What two meshes that do not match can both follow: of a facet of the first its mean and its tilt."""
    return operator.hat_shapes if len(sides) > 1 else None


Memory = tuple[Any, ...]


@dataclass(frozen=True, eq=False)
class Stacked(Deformable):
    """One body or two before the impact; ``operator`` of the one that has the points, angles on its ``radius``, m."""

    operator: SurfaceOperator
    sides: tuple[BodySide, ...]
    radius: float
    follows_contact: bool = False

    @property
    def factorizations(self) -> int:
        """Of all meshes."""
        return sum(side.factorizations for side in self.sides)

    @property
    def solves(self) -> int:
        """Of all meshes."""
        return sum(side.solves for side in self.sides)

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

    def body(self, relaxation: Relaxation, scheme: MemoryScheme, scale: float) -> StackedBody:
        """The bodies marched by a scheme; each has a modulus of its own, ``relaxation`` is that of all of them."""
        halves = tuple(side.half(scheme, scale) for side in self.sides)
        return StackedBody(self.operator, self.sides, halves, self._points)

    @cached_property
    def _points(self) -> PressedSurface:
        """What is known of the points alone, the same in all marches."""
        trace = np.hstack([side.trace for side in self.sides])
        blocks = block_diag(*(side.stiffness for side in self.sides))
        shared = carriers(self.operator, self.sides)
        return PressedSurface(blocks, trace, self.operator.weights, recurring=False, carriers=shared)

    def felt(self, snapshot: Snapshot) -> tuple[Array, Array]:
        """At the nodes, without the roughness that the shape functions do not see.

        Two meshes that do not match pin a facet more often than either can follow, as mortar methods with too many
        multipliers do (Wohlmuth 2011, doi:10.1017/S0962492911000079): its mean and its tilt alone are known then.
        """
        if len(self.sides) > 1:
            return self.radius * np.sin(self.operator.corners), self.operator.hats(snapshot.pressure)
        nodes = self.operator.nodes[: self.operator.trace.shape[1]]
        return self.radius * np.sin(nodes), self.operator.projected(snapshot.pressure)


@dataclass(frozen=True, eq=False)
class StackedBody:
    """The contract of :class:`fe_contact.bodies.offer.Body`; the memory is one for each of the ``halves``.

    ``points``: the surface of a steady body alone; of others what is known of their points.
    """

    operator: SurfaceOperator
    sides: tuple[BodySide, ...]
    halves: tuple[Half, ...]
    points: PressedSurface

    def at_rest(self) -> Memory:
        """Relaxed, undeformed bodies."""
        return tuple(half.at_rest() for half in self.halves)

    def offer(self, memory: Memory, length: float) -> Offer:
        """What contact meets in a step of a length, s."""
        found = [half.recalled(own, length) for half, own in zip(self.halves, memory, strict=True)]
        now = _together(one.now for one in found)
        past = np.zeros_like(self.operator.points)
        for side, one in zip(self.sides, found, strict=True):
            past += now / one.now * (side.trace @ one.past)
        return Offer(length, now, past, self._pressed(found, now))

    def after(self, memory: Memory, offer: Offer, pressure: Array) -> tuple[Memory, float]:
        """The memories after the step under a pressure (q,), and the first axis' elastic displacement times modulus."""
        forces = self.operator.weights * pressure
        loads = [side.trace.T @ forces for side in self.sides]
        moved = tuple(
            half.pushed(own, offer.length, load) for half, own, load in zip(self.halves, memory, loads, strict=True)
        )
        middle = int(np.abs(self.operator.nodes[: loads[0].size]).argmin())
        return moved, float(self.operator.compliance[middle] @ loads[0])

    def displacement(self, memory: Memory) -> Array:
        """Inward displacement of all surfaces at the quadrature points, (q,), m."""
        parts = zip(self.sides, self.halves, memory, strict=True)
        return np.asarray(sum(side.trace @ half.sunk(own) for side, half, own in parts))

    def stored(self, memory: Memory) -> float:
        """Elastic energy in all springs, J."""
        return sum(half.stored(own) for half, own in zip(self.halves, memory, strict=True))

    def heat_and_loss(self, before: Memory, after: Memory, length: float) -> tuple[float, float]:
        """Heat of a step, J, and of the work in it what the scheme leaves unaccounted for, J."""
        steps = zip(self.halves, before, after, strict=True)
        heats, losses = zip(*(half.heat_and_loss(first, then, length) for half, first, then in steps), strict=True)
        return sum(heats), sum(losses)

    def _pressed(self, found: Sequence[Offer], now: float) -> PressedSurface:
        """All sides, each with its modulus over the common one; a steady body alone is the same in every step."""
        steady = all(side.steady for side in self.sides)
        if steady and len(self.sides) == 1:
            return self.points
        weights = tuple(one.now / now for one in found)
        if steady:
            return stacked(self.operator, self.sides, weights)
        blocks = (weight * one.surface.stiffness for one, weight in zip(found, weights, strict=True))
        return self.points.stiffened(block_diag(*blocks))


def _together(moduli: Iterable[float]) -> float:
    return 1.0 / sum(1.0 / modulus for modulus in moduli)
