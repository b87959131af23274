"""The half-space under a flat end, whose rim no depth moves: the mesh is as fine there as the pressure is steep."""

from __future__ import annotations

import numpy as np
from skfem import FacetBasis

import meshes
from fe_contact.assembly import far_field as static
from fe_contact.assembly.cache import kept
from fe_contact.assembly.forms import isotropic, stiffness
from fe_contact.assembly.operators import basis_on, condensed, made
from fe_contact.assembly.surface import flat
from fe_contact.bodies.pressing import FixedStill, Still
from fe_contact.bodies.zone import REFINEMENT, held
from fe_contact.settings import Numerics
from fe_contact.steppers.scaled_surface import ScaledSurface
from lumped.scene.indenter import Indenter


def still(indenter: Indenter, radius: float, numerics: Numerics) -> Still:
    """The half-space at rest under an end of this radius, m."""
    elements = REFINEMENT * numerics.elements_per_contact
    surface = _surface(indenter.material.nu, elements, numerics.order, numerics.far_radius)
    return FixedStill(surface, indenter, numerics, radius, radius, np.inf)


@kept
def _surface(poisson: float, elements: float, order: int, far_radius: float) -> ScaledSurface:
    """Condensed for unit radius."""
    basis = basis_on(made(meshes.layer_under_rim, elements, far_radius, far_radius), order)
    ends = [basis.mesh.boundaries[name] for name in ("base", "side")]
    outside = FacetBasis(basis.mesh, basis.elem, facets=np.concatenate(ends), intorder=2 * order + 4)
    matrix = stiffness(basis, isotropic(1.0 - poisson**2, poisson)) + static.robin(outside, poisson)
    fixed = held(basis, along=("axis",), across=())
    return ScaledSurface(condensed(basis, matrix.tocsc(), fixed, poisson, flat(basis)), breathes=False)
