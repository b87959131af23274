"""The half-plane struck by a cylinder: depth relative to the point at the datum.

A finite block stands for it, so wide that what it adds is the same at the surface and at the datum.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from skfem import Basis

import meshes
from fe_contact.bodies.scaled_surface import ScaledSurface
from fe_contact.contact import ContactSolution
from fe_contact.errors import IndentationNotSettled
from fe_contact.forms import Array, isotropic, plane_stiffness
from fe_contact.numerics import Numerics
from fe_contact.operators import ELEMENTS, condensed
from fe_contact.pressing import FixedStill, Pressed, Still
from fe_contact.surface import flat
from fe_contact.targets._zone import REFINEMENT, Zone, held
from lumped.indenter import Indenter

FAR = 10.0  # size of the block over the datum's depth (or the contact's width), per far radius of the settings
SECANTS = 30
PRECISE = 1e-12


@dataclass(frozen=True)
class DatumStill:
    """A block pressed until the striker has moved by the depth relative to the datum; ``datum`` in reference radii."""

    block: FixedStill
    datum: float

    @property
    def degrees_of_freedom(self) -> int:
        """Unknowns of the one mesh."""
        return self.block.degrees_of_freedom

    def press(self, depth: float, guess: float) -> Pressed:
        """Press to a depth, m, relative to the datum: secants on the depth relative to the block's foot.

        Raises IndentationNotSettled.
        """
        known, absolute = (0.0, 0.0), depth
        problems = iterations = 0
        for _ in range(SECANTS):
            solution, solves = self.block.solved(absolute, guess)
            problems, iterations = problems + solves, iterations + solution.iterations
            if not solution.converged:
                break
            relative = absolute - self._sunk(solution)
            if abs(relative - depth) <= PRECISE * depth:
                found = self.block.press(absolute, guess)
                return Pressed(found.force, found.contact_radius, problems + found.problems, iterations)
            slope = (absolute - known[0]) / (relative - known[1])
            known, absolute = (absolute, relative), absolute + slope * (depth - relative)
        raise IndentationNotSettled(depth)

    def _sunk(self, solution: ContactSolution) -> float:
        """How far the datum sinks under the pressure, m."""
        operator = self.block.surface.operator
        displacement = operator.solve(operator.trace.T @ (operator.weights * solution.pressure))
        return -float((_at(operator.basis, self.datum) @ displacement[1::2])[0])


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The half-plane at rest; ``radii``, m: where the undeformed surfaces overlap at the depths to come."""
    datum, zone = getattr(indenter.target, "datum_depth", None), Zone.of(indenter.shape, radii)
    assert datum is not None
    size = FAR * numerics.far_radius * max(datum / zone.reference, 1.0)
    elements = REFINEMENT * numerics.elements_per_contact
    surface = _surface(indenter.material.nu, elements, numerics.order, zone.smallest, size)
    return DatumStill(
        FixedStill(surface, indenter, numerics, zone.reference, zone.reference), datum / zone.reference
    )


@lru_cache(maxsize=32)
def _surface(poisson: float, elements: float, order: int, smallest: float, size: float) -> ScaledSurface:
    basis = Basis(meshes.layer(elements, smallest, size, size), ELEMENTS[order](), intorder=2 * order)
    matrix = plane_stiffness(basis, isotropic(1.0 - poisson**2, poisson)).tocsc()
    fixed = held(basis, along=("axis", "base"), across=("base",))
    return ScaledSurface(condensed(basis, matrix, fixed, poisson, flat(basis, 2)), breathes=False)


@lru_cache(maxsize=32)
def _at(basis: Any, depth: float) -> Any:
    """Weights of the scalar degrees of freedom at the point below the first touch, sparse (1, N)."""
    return basis.probes(np.array([[0.0], [-depth]]))
