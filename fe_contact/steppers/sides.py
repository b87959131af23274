"""The sides of a contact: bodies under one pressure at common points, each with nodes and a memory of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from operator import attrgetter

import numpy as np
from scipy.linalg import block_diag

from fe_contact.assembly.elastic_body import ElasticBody
from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import SurfaceOperator
from fe_contact.assembly.pressed_surface import PressedSurface
from fe_contact.bodies.bulk_memory import BulkBody, Moduli
from fe_contact.bodies.condensed import ByModes, Condensed
from fe_contact.bodies.modes import Modes, modes
from fe_contact.bodies.offer import Half
from fe_contact.bodies.surface_body import SurfaceBody
from fe_contact.schemes.base import MemoryScheme
from fe_contact.steppers.bulk_surface import Pace
from lumped.materials import Relaxation


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

    @classmethod
    def of(
        cls,
        body: ElasticBody,
        moduli: Moduli,
        pace: Pace,
        relaxation: Relaxation,
        share: float = 1.0,
        trace: Callable[[SurfaceOperator], Array] = attrgetter("trace"),
    ) -> BulkSide:
        """A meshed body in an impact of this pace; ``trace``: at the common points, from its operator."""
        found = modes(body, *pace.ratios(moduli))
        return cls(found.operator, relaxation, trace(found.operator), share, modes=found, moduli=moduli)

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


def stacked(operator: SurfaceOperator, sides: tuple[BodySide, ...], weights: tuple[float, ...]) -> PressedSurface:
    """The sides under one pressure at the operator's points; ``weights``: modulus of each over the common one."""
    blocks = (weight * side.stiffness for side, weight in zip(sides, weights, strict=True))
    trace = np.hstack([side.trace for side in sides])
    shares = [side.at_points / weight for side, weight in zip(sides, weights, strict=True)] if len(sides) > 1 else []
    compliance = np.sum(shares, axis=0) if shares else None
    return PressedSurface(
        block_diag(*blocks),
        trace,
        operator.weights,
        recurring=False,
        compliance=compliance,
        carriers=carriers(operator, sides),
    )


def carriers(operator: SurfaceOperator, sides: tuple[BodySide, ...]) -> Array | None:
    """What two meshes that do not match can both follow: of a facet of the first its mean and its tilt."""
    return operator.hat_shapes if len(sides) > 1 else None
