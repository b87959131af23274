"""Bodies with lengths of their own, pressed at rest: one of them or two on one another, on one side or on both."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import SurfaceOperator
from fe_contact.assembly.pressed_surface import PressedSurface
from fe_contact.assembly.trace import trace_between
from fe_contact.bodies.pressing import BEYOND, EDGE_ORDER, Pressed, half_width
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.contact.problem import ContactProblem
from fe_contact.errors import ContactTooWide, IndentationNotSettled
from fe_contact.settings import Numerics
from lumped.scene.indenter import Indenter

STIFFER = 6.0  # penalty where the contact ends at a rim, over that where it may move: no edge asks for softness


@dataclass(frozen=True, eq=False)
class BodyStill:
    """Contact at fixed points on one mesh, whose unit is ``scale``, m.

    ``surface`` of all bodies, in units of their common modulus; ``operator`` of the one that has the points;
    ``places`` (q,) of the points as the target counts them, m, zero at the first touch.
    """

    surface: PressedSurface
    operator: SurfaceOperator
    places: Array
    scale: float
    indenter: Indenter
    numerics: Numerics
    degrees_of_freedom: int

    @property
    def mesh_order(self) -> float:
        """Less where the edge may lie anywhere in an element; a rim is a node."""
        return EDGE_ORDER if self.indenter.target.fixed_radius(self.indenter.shape) is None else np.inf

    @property
    def ends(self) -> bool:
        """It does."""
        return True

    def press(self, depth: float, guess: float) -> Pressed:
        """Press to a depth, m; raises IndentationNotSettled, or ContactTooWide where a contact leaves the fine mesh."""
        target, shape = self.indenter.target, self.indenter.shape
        fixed = target.fixed_radius(shape)
        overlap = target.overlap(self.indenter.profile, self.places, depth)
        penalty = self.numerics.penalty * self.scale / guess * (1.0 if fixed is None else STIFFER)
        problem = ContactProblem(self.surface, np.maximum(overlap, -BEYOND * self.scale), penalty)
        enforcement = ENFORCEMENTS.get(self.numerics.enforcement)
        solution = enforcement.enforce(problem, np.abs(self.places) < guess)
        gap, height = -solution.signed_pressure, target.lead * depth - overlap
        radius = fixed or half_width(self.places, solution.signed_pressure, gap, height=height)
        if not solution.converged or radius == 0.0:
            raise IndentationNotSettled(depth)
        if not np.isfinite(radius):
            raise ContactTooWide(depth)
        force = self.operator.force(self.scale, solution.pressure)
        return Pressed(force, radius, enforcement.solves, solution.iterations)


def trace_at(operator: SurfaceOperator, points: Array) -> Array:
    """Displacement at other points of the contact zone from that of the operator's nodes, (q, n)."""
    return trace_between(operator.corners, points, operator.order)
