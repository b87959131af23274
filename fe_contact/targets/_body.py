"""Bodies with lengths of their own, pressed at rest: one of them or two on one another, on one side or on both."""

from __future__ import annotations

from dataclasses import dataclass, replace
from types import ModuleType

import numpy as np
from scipy.linalg import block_diag

from fe_contact.contact import ContactProblem, ContactSolution, PressedSurface
from fe_contact.errors import IndentationNotSettled
from fe_contact.forms import Array
from fe_contact.numerics import ENFORCEMENTS, Numerics
from fe_contact.operators import SurfaceOperator, lagrange
from fe_contact.pressing import BEYOND, EDGE_ORDER, Pressed
from lumped.indenter import Indenter
from lumped.members import get

INSIDE = 0.95  # share of the contact whose pressure tells where it ends
DEGREE = 4  # of the polynomial through the pressure's square
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

    def press(self, depth: float, guess: float) -> Pressed:
        """Press to a depth, m; raises IndentationNotSettled, also where a growing contact leaves the fine mesh."""
        target, shape = self.indenter.target, self.indenter.shape
        fixed = target.fixed_radius(shape)
        overlap = target.overlap(self.indenter.profile, self.places, depth)
        penalty = self.numerics.penalty * self.scale / guess * (1.0 if fixed is None else STIFFER)
        problem = ContactProblem(self.surface, np.maximum(overlap, -BEYOND * self.scale), penalty)
        enforcement: ModuleType = get(ENFORCEMENTS, self.numerics.enforcement)
        solution = enforcement.enforce(problem, np.abs(self.places) < guess)
        radius = fixed or half_width(self.places, self.operator.weights, solution, self._felt(solution.pressure))
        if not solution.converged or not 0.0 < radius < np.inf:
            raise IndentationNotSettled(depth)
        force = self.operator.force(self.scale, solution.pressure)
        return Pressed(force, radius, enforcement.SOLVES, solution.iterations)

    def _felt(self, pressure: Array) -> Array:
        """The pressure without the roughness that the body's shape functions do not see."""
        root = np.sqrt(self.operator.weights)
        nodal, *_ = np.linalg.lstsq(root[:, None] * self.operator.trace, root * pressure, rcond=None)
        return np.asarray(self.operator.trace @ nodal)


def half_width(places: Array, weights: Array, solution: ContactSolution, felt: Array) -> float:
    """From the first touch to where the pressure ends; where there is a left side too, half from end to end.

    The square of the pressure ``felt`` is smooth and falls to zero like a straight line: it is read from all of the
    inside, each place with its weight, since near the end the pressure rings. Infinite where the contact reaches the
    last place, 0 without contact.
    """
    right = solution.edge(places)
    turned = replace(solution, signed_pressure=solution.signed_pressure[::-1])
    left = -right if places[0] > 0.0 else -turned.edge(-places[::-1])
    if not 0.0 < right - left < np.inf:
        return 0.0 if right == left else np.inf
    half = 0.5 * (right - left)
    x = (places - 0.5 * (left + right)) / half
    inside = np.abs(x) < INSIDE
    x, square, measure = x[inside], felt[inside] ** 2, np.sqrt(weights[inside])
    if places[0] > 0.0:  # the other side is its mirror
        x, square, measure = np.concatenate([-x, x]), np.tile(square, 2), np.tile(measure, 2)
    roots = np.polynomial.Polynomial.fit(x, square, DEGREE, w=measure).roots()
    real = np.real(roots[np.abs(np.imag(roots)) < 1e-9])
    ends = [real[np.abs(real - side) < 1.0 - INSIDE] for side in (-1.0, 1.0)]
    return half * 0.5 * float(ends[1][0] - ends[0][0]) if all(end.size == 1 for end in ends) else half


def stacked(
    first: SurfaceOperator, second: SurfaceOperator, ratio: float, shares: tuple[float, float]
) -> PressedSurface:
    """Two round bodies under one pressure, given at the points of the first: their displacements add.

    ``ratio``: radius of the first over that of the second, at least as large; points are angles. ``shares``: stiffness
    of each body's operator over that of the common one.
    """
    angles = np.arcsin(np.minimum(ratio * np.sin(first.points), 1.0))
    stiffness = block_diag(shares[0] * first.stiffness, shares[1] * second.stiffness)
    return PressedSurface(stiffness, np.hstack([first.trace, trace_at(second, angles)]), first.weights, False)


def trace_at(operator: SurfaceOperator, points: Array) -> Array:
    """Displacement at other points of the contact zone from that of the operator's nodes, (q, n)."""
    order, loaded = operator.order, operator.trace.shape[1]
    corners = operator.nodes[:loaded:order]
    facet = np.clip(np.searchsorted(corners, points) - 1, 0, len(corners) - 2)
    local = lagrange((points - corners[facet]) / (corners[facet + 1] - corners[facet]), order)
    trace = np.zeros((len(points), loaded))
    trace[np.arange(len(points))[:, None], order * facet[:, None] + np.arange(order + 1)] = local
    return trace
