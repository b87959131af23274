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
from fe_contact.assembly.surface import face, flat
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

Sizes = tuple[float, float, float, tuple[float, float, float] | None]  # see _mesh
SIDES = 0.4  # distance of the sides in thicknesses, per far radius of the settings


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The layer at rest; ``radii``, m: between which the contacts will end."""
    rim, profile = indenter.shape.fixed_radius, indenter.profile
    zone = Zone.of(radii, flat=profile.flat_radius) if rim is None else Zone(rim, 1.0)
    refinement = LINE_REFINEMENT if indenter.shape.plane else REFINEMENT
    thickness, body = _meshed(indenter.geometry, zone, refinement, numerics, rim is not None)
    surface = on_mesh(body, indenter.material.nu)
    return FixedStill(surface, indenter, numerics, zone.reference, zone.reference, thickness)


def solid(indenter: Indenter, radii: Array, numerics: Numerics) -> SolidMesh:
    """The layer for large strains; ``radii``, m: those of the contacts expected."""
    zone = Zone.of(radii, FINITE_MARGIN, indenter.profile.flat_radius)
    _, body = _meshed(indenter.geometry, zone, FINITE_REFINEMENT, numerics)
    return SolidMesh(body.follow(), zone.reference)


def meshed(geometry: Geometry, numerics: Numerics) -> Recipe[ElasticBody]:
    """The layer in an impact whose contact grows from nothing to the radius that the settings expect."""
    shape, reference = geometry.shape, numerics.contact_radius
    zone = Zone.struck(shape, reference) if shape.fixed_radius is None else Zone(reference, 1.0)
    return _meshed(geometry, zone, STRUCK_REFINEMENT, numerics)[1]


def _meshed(
    geometry: Geometry, zone: Zone, refinement: float, numerics: Numerics, alone: bool = False
) -> tuple[float, Recipe[ElasticBody]]:
    """Thickness over the radius of a zone, and the layer in its units; ``refinement``: elements over the usual.

    ``alone``: whether nothing beyond a rim is ever pressed.
    """
    target, rim = geometry.target, geometry.shape.fixed_radius is not None
    assert isinstance(target, Layer)
    thickness = thickness_over(zone.reference, target.thickness)
    elements, width = refinement * numerics.elements_per_contact, SIDES * numerics.far_radius * thickness
    sizes = (elements, thickness, width, None if rim else (zone.smallest, zone.flat, zone.beside))
    return thickness, _body.recipe(sizes, numerics.order, target.base == "bonded", geometry.shape.plane, alone)


@cached
def _body(sizes: Sizes, order: int, bonded: bool, plane: bool, alone: bool = False) -> ElasticBody:
    """In units of the reference radius, that of a rim where nothing beyond it is ever pressed: ``alone``."""
    basis = basis_on(_mesh(*sizes), order)
    fixed = held(basis, along=("axis", "side", "base") if bonded else ("axis",), across=("base",))
    pressed = face(basis, 1.0) if alone else flat(basis, 2 if plane else 3)
    return ElasticBody(basis, partial(matrix, basis, plane), fixed, pressed)


def _mesh(elements: float, thickness: float, width: float, ends: tuple[float, float, float] | None) -> MeshTri:
    """Fine wherever contacts end, or, without ``ends``, at the rim."""
    if ends is None:
        return made(meshes.layer_under_rim, elements, thickness, width)
    smallest, flat, beside = ends
    return made(meshes.layer, elements, smallest, thickness, width, flat, beside)


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
