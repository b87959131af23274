"""The layer on a rigid foundation: one mesh that resolves every contact radius alike, the sides far away."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from skfem import Basis, FacetBasis, MeshTri

import meshes
from fe_contact.bodies.scaled_surface import ScaledSurface
from fe_contact.far_field import plate
from fe_contact.forms import Array, isotropic, plane_stiffness, stiffness
from fe_contact.numerics import Numerics
from fe_contact.operators import ELEMENTS, condensed
from fe_contact.pressing import FixedStill, Still
from fe_contact.surface import flat
from fe_contact.targets._zone import LINE_REFINEMENT, REFINEMENT, STRUCK_REFINEMENT, Zone, held, smallest_struck
from lumped.indenter import Indenter
from lumped.scene import Geometry
from lumped.targets.layer import Layer

SIDES = 0.4  # distance of the sides in thicknesses, per far radius of the settings


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The layer at rest; ``radii``, m: between which the contacts will end."""
    target = indenter.target
    assert isinstance(target, Layer)
    rim = indenter.shape.fixed_radius
    zone = Zone.of(radii) if rim is None else Zone(rim, 1.0)
    thickness = target.thickness / zone.reference
    refinement = LINE_REFINEMENT if indenter.shape.plane else REFINEMENT
    elements, width = refinement * numerics.elements_per_contact, SIDES * numerics.far_radius * thickness
    sizes, bonded = (elements, zone.smallest if rim is None else None, thickness, width), target.base == "bonded"
    surface = _surface(indenter.material.nu, sizes, numerics.order, bonded, indenter.shape.plane)
    return FixedStill(surface, indenter, numerics, zone.reference, zone.reference, thickness)


def struck(geometry: Geometry, numerics: Numerics) -> ScaledSurface:
    """The layer in an impact whose contact grows from nothing to the radius that the settings expect."""
    target = geometry.target
    assert isinstance(target, Layer)
    thickness = target.thickness / numerics.contact_radius
    smallest = None if geometry.shape.fixed_radius is not None else smallest_struck(geometry.shape)
    elements, width = STRUCK_REFINEMENT * numerics.elements_per_contact, SIDES * numerics.far_radius * thickness
    sizes, bonded = (elements, smallest, thickness, width), target.base == "bonded"
    return _surface(geometry.material.nu, sizes, numerics.order, bonded, geometry.shape.plane)


@lru_cache(maxsize=32)
def _surface(
    poisson: float, sizes: tuple[float, float | None, float, float], order: int, bonded: bool, plane: bool
) -> ScaledSurface:
    """Condensed for unit reference radius."""
    mesh = _mesh(*sizes)
    basis = Basis(mesh, ELEMENTS[order](), intorder=2 * order)
    fixed = held(basis, along=("axis", "side", "base") if bonded else ("axis",), across=("base",))
    matrix = _matrix(basis, poisson, bonded, plane).tocsc()
    operator = condensed(basis, matrix, fixed, poisson, flat(basis, 2 if plane else 3))
    return ScaledSurface(operator, breathes=False)


def _mesh(elements: float, smallest: float | None, thickness: float, width: float) -> MeshTri:
    """Fine for every contact from the smallest, or, without one, at the rim."""
    if smallest is None:
        return meshes.layer_under_rim(elements, thickness, width)
    return meshes.layer(elements, smallest, thickness, width)


def _matrix(basis: Any, poisson: float, bonded: bool, plane: bool) -> Any:
    """Stiffness of the layer, and of what lies beyond its sides: a sliding one gives way to the end of the world."""
    law = isotropic(1.0 - poisson**2, poisson)
    if plane:
        return plane_stiffness(basis, law)
    if bonded:
        return stiffness(basis, law)
    sides = FacetBasis(basis.mesh, basis.elem, facets=basis.mesh.boundaries["side"], intorder=2 * basis.elem.maxdeg)
    return stiffness(basis, law) + plate.robin(sides, poisson)
