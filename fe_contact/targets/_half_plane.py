"""The half-plane struck by a cylinder: depth relative to the point at the datum."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy.sparse as sparse
from skfem import Basis, FacetBasis

import meshes
from fe_contact.bodies.scaled_surface import ScaledSurface
from fe_contact.errors import IndentationNotSettled
from fe_contact.far_field import half_plane
from fe_contact.forms import Array, isotropic, plane_stiffness
from fe_contact.numerics import Numerics
from fe_contact.operators import ELEMENTS, condensed
from fe_contact.pressing import FixedStill, Pressed, Still
from fe_contact.surface import flat
from fe_contact.targets._zone import REFINEMENT, Zone, held
from lumped.indenter import Indenter

SECANTS = 30
PRECISE = 1e-10


@dataclass(frozen=True)
class DatumStill:
    """A block pressed until the striker has moved by the depth relative to the datum."""

    block: FixedStill

    @property
    def degrees_of_freedom(self) -> int:
        """Unknowns of the one mesh."""
        return self.block.degrees_of_freedom

    def press(self, depth: float, guess: float) -> Pressed:
        """Press to a depth, m, relative to the datum: secants on the depth relative to the block's outside.

        A flat end with the contact's radius tells the first slope. Raises IndentationNotSettled.
        """
        operator = self.block.surface.operator
        punched = operator.punched(guess / self.block.reference)
        slope = 1.0 / (1.0 + float(operator.watched[: punched.size] @ punched))
        absolute, known = 0.5 * (1.0 + slope) * depth, (0.0, 0.0)
        touching, problems, iterations = self.block.within(guess), 0, 0
        for attempt in range(SECANTS):
            solution, solves = self.block.solved(absolute, guess, touching)
            problems, iterations = problems + solves, iterations + solution.iterations
            if not solution.converged:
                break
            relative = absolute + float(operator.watched @ (operator.trace.T @ (operator.weights * solution.pressure)))
            if abs(relative - depth) <= PRECISE * depth:
                return self.block.read(depth, solution, problems, iterations)
            if attempt:
                slope = (absolute - known[0]) / (relative - known[1])
            known, absolute = (absolute, relative), absolute + slope * (depth - relative)
            touching = solution.sets[0]
        raise IndentationNotSettled(depth)


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The half-plane at rest; ``radii``, m: between which the contacts will end."""
    datum, zone = getattr(indenter.target, "datum_depth", None), Zone.of(radii)
    assert datum is not None
    elements, depth = REFINEMENT * numerics.elements_per_contact, datum / zone.reference
    size = numerics.far_radius * max(depth, 1.0)
    surface = _surface(indenter.material.nu, elements, numerics.order, zone.smallest, depth, size)
    return DatumStill(FixedStill(surface, indenter, numerics, zone.reference, zone.reference, np.inf))


@lru_cache(maxsize=32)
def _surface(
    poisson: float, elements: float, order: int, smallest: float, datum: float, size: float
) -> ScaledSurface:
    """Condensed for unit reference radius, with the datum's displacement upwards."""
    basis = Basis(meshes.layer(elements, smallest, size, size), ELEMENTS[order](), intorder=2 * order)
    boundaries = basis.mesh.boundaries
    outside = FacetBasis(
        basis.mesh,
        basis.elem,
        facets=np.concatenate([boundaries["base"], boundaries["side"]]),
        intorder=2 * order + 4,
    )
    law = isotropic(1.0 - poisson**2, poisson)
    matrix = (plane_stiffness(basis, law) + half_plane.robin(outside, poisson)).tocsc()
    upwards = sparse.kron(basis.probes(np.array([[0.0], [-datum]])), [[0.0, 1.0]])
    fixed = held(basis, along=("axis",), across=())
    return ScaledSurface(condensed(basis, matrix, fixed, poisson, flat(basis, 2), upwards), breathes=False)
