"""The ring, held outside, struck from inside: half of it laid flat, with its exact arcs in the strain."""

from __future__ import annotations

import math

import numpy as np

import meshes
from fe_contact.assembly.cache import kept
from fe_contact.assembly.elastic_body import ElasticBody
from fe_contact.assembly.forms import Array, Matrix, elastic, polar_stiffness
from fe_contact.assembly.operators import basis_on, made
from fe_contact.assembly.surface import flat
from fe_contact.bodies.bulk_memory import Moduli
from fe_contact.bodies.pressing import FixedStill, Still
from fe_contact.bodies.zone import (
    LINE_REFINEMENT,
    MARGIN,
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
    surface = _surface(indenter.material.nu, elements, numerics.order, zone.smallest, thickness, angle)
    return FixedStill(surface, indenter, numerics, zone.reference, angle, thickness)


def struck(geometry: Geometry, numerics: Numerics) -> ScaledSurface:
    """The ring in an impact whose contact grows from nothing to the arc that the settings expect."""
    return _surface(geometry.material.nu, *_shape(geometry, numerics))


def relaxing(geometry: Geometry, numerics: Numerics) -> BulkSurface:
    """The same of constant bulk modulus."""
    moduli = Moduli.of(geometry.material, geometry.shape.total)
    return bulk_surface.relaxing(meshed(geometry, numerics), moduli, numerics)


def meshed(geometry: Geometry, numerics: Numerics) -> ElasticBody:
    """The same for every Poisson's ratio."""
    return _body(*_shape(geometry, numerics))


def _shape(geometry: Geometry, numerics: Numerics) -> tuple[float, int, float, float, float]:
    """Elements along the zone, their order, the smallest contact, thickness and angle in units of the zone."""
    target = geometry.target
    assert isinstance(target, Ring)
    reference = min(numerics.contact_radius, WIDEST * target.inner_radius)
    elements = STRUCK_REFINEMENT * numerics.elements_per_contact
    angle, thickness = reference / target.inner_radius, thickness_over(reference, target.thickness)
    return elements, numerics.order, smallest_struck(geometry.shape), thickness, angle


@kept
def _surface(
    poisson: float, elements: float, order: int, smallest: float, thickness: float, angle: float
) -> ScaledSurface:
    """Condensed for a contact zone of unit arc length, which spans ``angle``, rad; ``thickness`` in its units."""
    return ScaledSurface(_body(elements, order, smallest, thickness, angle).operator(poisson), breathes=False)


@kept
def _body(elements: float, order: int, smallest: float, thickness: float, angle: float) -> ElasticBody:
    """In units of the zone's arc length."""
    basis = basis_on(made(meshes.ring, elements, smallest, thickness, math.pi / angle), order)
    fixed = held(basis, along=("axis", "side", "base"), across=("base",))
    surface = flat(basis, 2, lambda place: np.cos(angle * place))

    def matrix(bulk: float, shear: float) -> Matrix:
        return polar_stiffness(basis, elastic(bulk, shear), 1.0 / angle)

    return ElasticBody(basis, matrix, fixed, surface)


MEMBER = MeshedTarget(still, struck=struck, relaxing=relaxing)
