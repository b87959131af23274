"""The ring, held outside, struck from inside: half of it laid flat, with its exact arcs in the strain."""

from __future__ import annotations

import math

import numpy as np

import meshes
from fe_contact.assembly.cache import Recipe, cached
from fe_contact.assembly.forms import Array, Matrix, elastic, polar_stiffness
from fe_contact.assembly.operators import ElasticBody, SolidMesh, basis_on, made
from fe_contact.assembly.surface import flat
from fe_contact.bodies.pressing import (
    FINITE_MARGIN,
    FINITE_REFINEMENT,
    LINE_REFINEMENT,
    MARGIN,
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
from lumped.targets.ring import Ring

WIDEST = 2.7  # rad: the contact zone ends before the far side of the ring


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The ring at rest; ``radii``, m of arc: between which the contacts will end.

    The whole ring is meshed, so that there is no far field.
    """
    target = indenter.target
    assert isinstance(target, Ring)
    zone = Zone.of(np.minimum(radii, WIDEST / MARGIN * target.inner_radius))
    angle, thickness = zone.reference / target.inner_radius, thickness_over(zone.reference, target.thickness)
    elements = LINE_REFINEMENT * numerics.elements_per_contact
    surface = on_mesh(_body.recipe(elements, numerics.order, zone.smallest, thickness, angle), indenter.material.nu)
    return FixedStill(surface, indenter, numerics, zone.reference, angle, thickness)


def solid(indenter: Indenter, radii: Array, numerics: Numerics) -> SolidMesh:
    """The ring for large strains; ``radii``, m of arc: those of the contacts expected."""
    target, zone = indenter.target, Zone.of(radii, FINITE_MARGIN)
    assert isinstance(target, Ring)
    reference = min(zone.reference, WIDEST * target.inner_radius)
    angle, thickness = reference / target.inner_radius, thickness_over(reference, target.thickness)
    elements = FINITE_REFINEMENT * numerics.elements_per_contact
    body = _body(elements, numerics.order, zone.smallest, thickness, angle)
    return SolidMesh(body, reference, inner_radius=1.0 / angle, ends=True)


def meshed(geometry: Geometry, numerics: Numerics) -> Recipe[ElasticBody]:
    """The ring in an impact whose contact grows from nothing to the arc that the settings expect."""
    target = geometry.target
    assert isinstance(target, Ring)
    reference = min(numerics.contact_radius, WIDEST * target.inner_radius)
    elements = STRUCK_REFINEMENT * numerics.elements_per_contact
    angle, thickness = reference / target.inner_radius, thickness_over(reference, target.thickness)
    return _body.recipe(elements, numerics.order, smallest_struck(geometry.shape), thickness, angle)


@cached
def _body(elements: float, order: int, smallest: float, thickness: float, angle: float) -> ElasticBody:
    """In units of the zone's arc length, which spans ``angle``, rad."""
    basis = basis_on(made(meshes.ring, elements, smallest, thickness, math.pi / angle), order)
    fixed = held(basis, along=("axis", "side", "base"), across=("base",))
    surface = flat(basis, 2, lambda place: np.cos(angle * place))

    def matrix(bulk: float, shear: float) -> Matrix:
        return polar_stiffness(basis, elastic(bulk, shear), 1.0 / angle)

    return ElasticBody(basis, matrix, fixed, surface)


MEMBER = MeshedTarget.meshed(still, meshed, solid)
