"""The layer on a rigid foundation: one mesh that resolves every contact radius alike, the sides far away.

The outside of a layer that slides on its base: far from the contact a plate in plane stress, u_r ~ 1/r.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import scipy.sparse as sparse
from skfem import FacetBasis, MeshTri

import meshes
from fe_contact.assembly.cache import kept
from fe_contact.assembly.elastic_body import ElasticBody
from fe_contact.assembly.far_field import on_boundary
from fe_contact.assembly.forms import Array, Basis, Matrix, elastic, plane_stiffness, stiffness
from fe_contact.assembly.operators import basis_on, made
from fe_contact.assembly.surface import flat
from fe_contact.bodies.bulk_memory import Moduli
from fe_contact.bodies.pressing import FixedStill, Still
from fe_contact.bodies.zone import (
    LINE_REFINEMENT,
    REFINEMENT,
    STRUCK_REFINEMENT,
    Zone,
    held,
    smallest_struck,
    thickness_over,
)
from fe_contact.settings import Numerics
from fe_contact.steppers import bulk_surface
from fe_contact.steppers.bulk_surface import BulkSurface
from fe_contact.steppers.scaled_surface import ScaledSurface
from fe_contact.targets.base import MeshedTarget
from lumped.scene.geometry import Geometry
from lumped.scene.indenter import Indenter
from lumped.targets.layer import Layer

Sizes = tuple[float, float | None, float, float]  # elements, smallest contact, thickness, width: see _mesh
SIDES = 0.4  # distance of the sides in thicknesses, per far radius of the settings


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The layer at rest; ``radii``, m: between which the contacts will end."""
    target = indenter.target
    assert isinstance(target, Layer)
    rim = indenter.shape.fixed_radius
    zone = Zone.of(radii) if rim is None else Zone(rim, 1.0)
    thickness = thickness_over(zone.reference, target.thickness)
    refinement = LINE_REFINEMENT if indenter.shape.plane else REFINEMENT
    elements, width = refinement * numerics.elements_per_contact, SIDES * numerics.far_radius * thickness
    sizes, bonded = (elements, zone.smallest if rim is None else None, thickness, width), target.base == "bonded"
    surface = _surface(indenter.material.nu, sizes, numerics.order, bonded, indenter.shape.plane)
    return FixedStill(surface, indenter, numerics, zone.reference, zone.reference, thickness)


def struck(geometry: Geometry, numerics: Numerics) -> ScaledSurface:
    """The layer in an impact whose contact grows from nothing to the radius that the settings expect."""
    return _surface(geometry.material.nu, *_shape(geometry, numerics))


def relaxing(geometry: Geometry, numerics: Numerics) -> BulkSurface:
    """The same of constant bulk modulus."""
    moduli = Moduli.of(geometry.material, geometry.shape.total)
    return bulk_surface.relaxing(meshed(geometry, numerics), moduli, numerics)


def meshed(geometry: Geometry, numerics: Numerics) -> ElasticBody:
    """The same for every Poisson's ratio."""
    return _body(*_shape(geometry, numerics))


def _shape(geometry: Geometry, numerics: Numerics) -> tuple[Sizes, int, bool, bool]:
    """Sizes of the mesh in an impact, order of its elements, whether bonded, whether in plane strain."""
    target = geometry.target
    assert isinstance(target, Layer)
    thickness = thickness_over(numerics.contact_radius, target.thickness)
    smallest = None if geometry.shape.fixed_radius is not None else smallest_struck(geometry.shape)
    elements, width = STRUCK_REFINEMENT * numerics.elements_per_contact, SIDES * numerics.far_radius * thickness
    return (elements, smallest, thickness, width), numerics.order, target.base == "bonded", geometry.shape.plane


@kept
def _surface(poisson: float, sizes: Sizes, order: int, bonded: bool, plane: bool) -> ScaledSurface:
    """Condensed for unit reference radius."""
    return ScaledSurface(_body(sizes, order, bonded, plane).operator(poisson), breathes=False)


@kept
def _body(sizes: Sizes, order: int, bonded: bool, plane: bool) -> ElasticBody:
    """In units of the reference radius."""
    basis = basis_on(_mesh(*sizes), order)
    fixed = held(basis, along=("axis", "side", "base") if bonded else ("axis",), across=("base",))
    return ElasticBody(basis, partial(matrix, basis, bonded, plane), fixed, flat(basis, 2 if plane else 3))


def _mesh(elements: float, smallest: float | None, thickness: float, width: float) -> MeshTri:
    """Fine for every contact from the smallest, or, without one, at the rim."""
    if smallest is None:
        return made(meshes.layer_under_rim, elements, thickness, width)
    return made(meshes.layer, elements, smallest, thickness, width)


def matrix(basis: Basis, bonded: bool, plane: bool, bulk: float, shear: float) -> Matrix:
    """Stiffness of the layer, and of what lies beyond its sides: a sliding one gives way to the end of the world."""
    law = elastic(bulk, shear)
    if plane:
        return plane_stiffness(basis, law)
    if bonded:
        return stiffness(basis, law)
    sides = FacetBasis(basis.mesh, basis.elem, facets=basis.mesh.boundaries["side"], intorder=2 * basis.elem.maxdeg)
    return stiffness(basis, law) + robin(sides, shear)


MEMBER = MeshedTarget(still, struck=struck, relaxing=relaxing)


def robin(facets: Basis, shear: float) -> sparse.coo_matrix:
    """Radial springs E/((1 + nu) r) = 2 G/r on the layer's side, of the shear modulus alone, shape (2 N, 2 N)."""
    radius = np.asarray(facets.global_coordinates())[0]
    tensor = np.zeros((2, 2, *radius.shape))
    tensor[0, 0] = 2.0 * shear / radius
    return on_boundary(facets, tensor, 2 * np.pi * radius)
