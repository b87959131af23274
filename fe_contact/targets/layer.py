"""The layer on a rigid foundation: one mesh that resolves every contact radius alike, the sides far away.

The outside of a layer that slides on its base: far from the contact a plate in plane stress, u_r ~ 1/r.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sparse

import meshes
from fe_contact.assembly.cache import Recipe, cached
from fe_contact.assembly.far_field import on_boundary
from fe_contact.assembly.forms import Array, Basis, Matrix, elastic, stiffness
from fe_contact.assembly.operators import ElasticBody, SolidMesh, basis_on, boundary, made
from fe_contact.assembly.surface import flat
from fe_contact.bodies.pressing import (
    FINITE_MARGIN,
    FINITE_REFINEMENT,
    LINE_REFINEMENT,
    REFINEMENT,
    STRUCK_REFINEMENT,
    FixedStill,
    Still,
    Zone,
    held,
    smallest_struck,
    thickness_over,
)
from fe_contact.settings import Numerics
from fe_contact.steppers.scaled_surface import on_mesh
from fe_contact.targets.base import MeshedTarget
from lumped.scene.geometry import Geometry
from lumped.scene.indenter import Indenter
from lumped.targets.layer import Layer

if TYPE_CHECKING:
    from skfem import MeshTri

Sizes = tuple[float, float | None, float, float]  # elements, smallest contact, thickness, width: see _mesh
SIDES = 0.4  # distance of the sides in thicknesses, per far radius of the settings


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The layer at rest; ``radii``, m: between which the contacts will end."""
    reference, smallest = _pressed(indenter.shape.fixed_radius, radii)
    refinement = LINE_REFINEMENT if indenter.shape.plane else REFINEMENT
    thickness, body = _meshed(indenter.geometry, reference, smallest, refinement, numerics)
    surface = on_mesh(body, indenter.material.nu)
    return FixedStill(surface, indenter, numerics, reference, reference, thickness)


def solid(indenter: Indenter, radii: Array, numerics: Numerics) -> SolidMesh:
    """The layer for large strains; ``radii``, m: those of the contacts expected."""
    zone = Zone.of(radii, FINITE_MARGIN)
    _, body = _meshed(indenter.geometry, zone.reference, zone.smallest, FINITE_REFINEMENT, numerics)
    return SolidMesh(body.follow(), zone.reference)


def _pressed(rim: float | None, radii: Array) -> tuple[float, float | None]:
    """The largest of contact ``radii``, m, and the smallest over it; of an end with a ``rim``, m, that alone."""
    if rim is not None:
        return rim, None
    zone = Zone.of(radii)
    return zone.reference, zone.smallest


def meshed(geometry: Geometry, numerics: Numerics) -> Recipe[ElasticBody]:
    """The layer in an impact whose contact grows from nothing to the radius that the settings expect."""
    smallest = None if geometry.shape.fixed_radius is not None else smallest_struck(geometry.shape)
    return _meshed(geometry, numerics.contact_radius, smallest, STRUCK_REFINEMENT, numerics)[1]


def _meshed(
    geometry: Geometry, reference: float, smallest: float | None, refinement: float, numerics: Numerics
) -> tuple[float, Recipe[ElasticBody]]:
    """Thickness over the ``reference`` radius, m, and the layer in its units; ``refinement``: elements over the usual.

    ``smallest`` contact over the reference, None under a rim.
    """
    target = geometry.target
    assert isinstance(target, Layer)
    thickness = thickness_over(reference, target.thickness)
    elements, width = refinement * numerics.elements_per_contact, SIDES * numerics.far_radius * thickness
    sizes = (elements, smallest, thickness, width)
    return thickness, _body.recipe(sizes, numerics.order, target.base == "bonded", geometry.shape.plane)


@cached
def _body(sizes: Sizes, order: int, bonded: bool, plane: bool) -> ElasticBody:
    """In units of the reference radius."""
    basis = basis_on(_mesh(*sizes), order)
    fixed = held(basis, along=("axis", "side", "base") if bonded else ("axis",), across=("base",))
    return ElasticBody(basis, partial(matrix, basis, plane), fixed, flat(basis, 2 if plane else 3))


def _mesh(elements: float, smallest: float | None, thickness: float, width: float) -> MeshTri:
    """Fine for every contact from the smallest, or, without one, at the rim."""
    if smallest is None:
        return made(meshes.layer_under_rim, elements, thickness, width)
    return made(meshes.layer, elements, smallest, thickness, width)


def matrix(basis: Basis, plane: bool, bulk: float, shear: float) -> Matrix:
    """Stiffness of the layer, and of what lies beyond its side: one that slides gives way to the end of the world.

    A bonded one is held there, or has died away.
    """
    own = stiffness(basis, elastic(bulk, shear), plane)
    return own if plane else own + robin(boundary(basis, ("side",)), shear)


def robin(facets: Basis, shear: float) -> sparse.coo_matrix:
    """Radial springs E/((1 + nu) r) = 2 G/r on the layer's side, of the shear modulus alone, shape (2 N, 2 N)."""
    radius = np.asarray(facets.global_coordinates())[0]
    tensor = np.zeros((2, 2, *radius.shape))
    tensor[0, 0] = 2.0 * shear / radius
    return on_boundary(facets, tensor, 2 * np.pi * radius)


MEMBER = MeshedTarget.meshed(still, meshed, solid)
