"""The homogeneous half-space: graded quarter disc, point-force far field, one operator for every scale.

The half-space under a flat end, whose rim no depth moves: the mesh is as fine there as the pressure is steep.
"""

from __future__ import annotations

import numpy as np
from skfem import FacetBasis

import meshes
from fe_contact.assembly import far_field as static
from fe_contact.assembly.cache import kept
from fe_contact.assembly.forms import Array, isotropic, stiffness
from fe_contact.assembly.operators import basis_on, condensed, made, surface_operator
from fe_contact.assembly.surface import flat
from fe_contact.bodies.pressing import FixedStill, ScaledStill, Still
from fe_contact.bodies.zone import REFINEMENT, held
from fe_contact.settings import Numerics
from fe_contact.steppers.scaled_surface import ScaledSurface
from fe_contact.targets import _half_plane as half_plane
from fe_contact.targets.base import MeshedTarget
from lumped.scene.geometry import Geometry
from lumped.scene.indenter import Indenter


def surface(poisson: float, numerics: Numerics) -> ScaledSurface:
    """Contact surface for these settings; made once a process, then shared by every impact that agrees."""
    return _surface(poisson, numerics.elements_per_contact, numerics.order, numerics.far_radius)


def struck(geometry: Geometry, numerics: Numerics) -> ScaledSurface:
    """The half-space in an impact, or the half-plane relative to its datum."""
    if geometry.shape.plane:
        return half_plane.struck(geometry, numerics)
    return surface(geometry.material.nu, numerics)


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The half-space at rest, or the half-plane relative to its datum; ``radii``: of the contacts, m."""
    if indenter.shape.plane:
        return half_plane.still(indenter, radii, numerics)
    if indenter.shape.fixed_radius is not None:
        return under_rim(indenter, indenter.shape.fixed_radius, numerics)
    return ScaledStill(surface(indenter.material.nu, numerics), indenter, numerics)


@kept
def _surface(poisson: float, elements: float, order: int, far_radius: float) -> ScaledSurface:
    return ScaledSurface(surface_operator(made(meshes.half_space, elements, far_radius), order, poisson))


MEMBER = MeshedTarget(still, struck=struck)


def under_rim(indenter: Indenter, radius: float, numerics: Numerics) -> Still:
    """The half-space at rest under an end of this radius, m."""
    elements = REFINEMENT * numerics.elements_per_contact
    surface = _rimmed(indenter.material.nu, elements, numerics.order, numerics.far_radius)
    return FixedStill(surface, indenter, numerics, radius, radius, np.inf)


@kept
def _rimmed(poisson: float, elements: float, order: int, far_radius: float) -> ScaledSurface:
    """Condensed for unit radius."""
    basis = basis_on(made(meshes.layer_under_rim, elements, far_radius, far_radius), order)
    ends = [basis.mesh.boundaries[name] for name in ("base", "side")]
    outside = FacetBasis(basis.mesh, basis.elem, facets=np.concatenate(ends), intorder=2 * order + 4)
    matrix = stiffness(basis, isotropic(1.0 - poisson**2, poisson)) + static.robin(outside, poisson)
    fixed = held(basis, along=("axis",), across=())
    return ScaledSurface(condensed(basis, matrix.tocsc(), fixed, poisson, flat(basis)), breathes=False)
