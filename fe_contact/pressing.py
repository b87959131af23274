"""A rigid profile pressed into a body at rest: the contact problem at one depth, elastic with unit modulus."""

from __future__ import annotations

from dataclasses import dataclass, replace
from types import ModuleType
from typing import Protocol

import numpy as np

from fe_contact.bodies.scaled_surface import ScaledSurface
from fe_contact.contact import ContactSolution, Touching
from fe_contact.errors import IndentationNotSettled
from fe_contact.forms import Array
from fe_contact.numerics import ENFORCEMENTS, Numerics
from lumped.indenter import Indenter
from lumped.members import get

EDGE_WINDOW = 0.02  # the contact edge may lie this far from the node where the mesh is finest
RESCALINGS = 60
BEYOND = 1e3  # height, in contact radii, given to radii past the striker's rim
EDGE_FIT = (0.6, 0.97)  # shares of the contact radius between which the pressure tells where it ends
EDGE_DEGREE = 2


@dataclass(frozen=True)
class Pressed:
    """Force over modulus, m^2, and contact radius, m, at one depth; contact problems and Newton iterations spent."""

    force: float
    contact_radius: float
    problems: int
    iterations: int


class Still(Protocol):
    """A body at rest, ready to be pressed by one profile."""

    @property
    def degrees_of_freedom(self) -> int:
        """Unknowns of the finite-element system behind it."""

    def press(self, depth: float, guess: float) -> Pressed:
        """Press to a depth, m; ``guess``: a contact radius to begin with, m. Raises NotReached."""


@dataclass(frozen=True)
class ScaledStill:
    """A body without a length of its own: the mesh is scaled until the contact edge lies in its finest elements."""

    surface: ScaledSurface
    indenter: Indenter
    numerics: Numerics

    @property
    def degrees_of_freedom(self) -> int:
        """Unknowns of the one mesh."""
        return self.surface.operator.degrees_of_freedom

    def press(self, depth: float, guess: float) -> Pressed:
        """Press to a depth, m. Raises IndentationNotSettled."""
        operator, profile, fixed = self.surface.operator, self.indenter.profile, self.indenter.profile.fixed_radius
        scale, iterations = guess, 0
        for attempt in range(1, RESCALINGS + 1):
            overlap = self.indenter.target.overlap(profile, scale * operator.points, depth)
            solution, solves = _enforced(self.surface, overlap, scale, self.numerics, operator.points < 1.0)
            iterations += solution.iterations
            if not solution.converged:
                break
            edge = solution.edge(operator.points)
            if abs(edge - 1.0) <= EDGE_WINDOW:
                force = operator.force(scale, solution.pressure)
                return Pressed(force, fixed or scale * edge, attempt * solves, iterations)
            scale *= min(max(edge, 0.3), operator.points[-1])
        raise IndentationNotSettled(depth)


@dataclass(frozen=True)
class FixedStill:
    """A body with lengths of its own, on one mesh in units of ``reference``, m: the contact may end anywhere in it.

    ``stretch``: the target's place on the surface over the mesh's coordinate.
    """

    surface: ScaledSurface
    indenter: Indenter
    numerics: Numerics
    reference: float
    stretch: float

    @property
    def degrees_of_freedom(self) -> int:
        """Unknowns of the one mesh."""
        return self.surface.operator.degrees_of_freedom

    def press(self, depth: float, guess: float) -> Pressed:
        """Press to a depth, m; raises IndentationNotSettled, also where the contact leaves the fine mesh."""
        solution, solves = self.solved(depth, guess)
        operator, shape = self.surface.operator, self.indenter.shape
        edge = solution.edge(operator.points)
        if not solution.converged or not np.isfinite(edge):
            raise IndentationNotSettled(depth)
        radius = shape.fixed_radius or self.reference * contact_end(operator.points, solution)
        force = operator.force(self.reference, solution.pressure)
        return Pressed(force, radius, solves, solution.iterations)

    def solved(self, depth: float, guess: float) -> tuple[ContactSolution, int]:
        """The contact problem at a depth, m, and how many solves it took."""
        operator, expected = self.surface.operator, guess / self.reference
        overlap = self.indenter.target.overlap(self.indenter.profile, self.stretch * operator.points, depth)
        numerics = replace(self.numerics, penalty=self.numerics.penalty / expected)
        return _enforced(self.surface, overlap, self.reference, numerics, operator.points < expected)


def _enforced(
    surface: ScaledSurface, overlap: Array, scale: float, numerics: Numerics, touching: Touching
) -> tuple[ContactSolution, int]:
    """The contact problem on the mesh scaled by ``scale``, m; and how many solves it took."""
    enforcement: ModuleType = get(ENFORCEMENTS, numerics.enforcement)
    problem = surface.problem(np.maximum(overlap, -BEYOND * scale), numerics.penalty, 0.0)
    return enforcement.enforce(problem, touching), enforcement.SOLVES


def contact_end(points: Array, solution: ContactSolution) -> float:
    """Where the pressure ends, from its inside: its square is smooth and falls to zero like a straight line.

    At the edge itself, anywhere in an element, the pressure rings.
    """
    edge, pressure = solution.edge(points), solution.pressure
    inside = (points > EDGE_FIT[0] * edge) & (points < EDGE_FIT[1] * edge)
    if np.count_nonzero(inside) <= 2 * EDGE_DEGREE:
        return edge
    fit = np.polynomial.Polynomial.fit(points[inside], pressure[inside] ** 2, EDGE_DEGREE)
    roots = fit.roots()
    real = np.real(roots[np.abs(np.imag(roots)) < 1e-9 * edge])
    near = real[(real > EDGE_FIT[1] * edge) & (real < (2.0 - EDGE_FIT[1]) * edge)]
    return float(near[np.argmin(np.abs(near - edge))]) if near.size else edge
