"""The O-ring between two planes: the upper half of its section, which a contact may cover on both sides of its top."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import meshes
from fe_contact.assembly.cache import cached
from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import ElasticBody, SolidMesh, basis_on, made
from fe_contact.assembly.surface import crown
from fe_contact.bodies.pressing import (
    FINITE_REFINEMENT,
    LINE_REFINEMENT,
    STRUCK_REFINEMENT,
    BodyStill,
    Still,
    Zone,
    held,
    struck_ends,
)
from fe_contact.settings import Numerics
from fe_contact.steppers.bulk_surface import Pace
from fe_contact.steppers.scaled_surface import on_mesh
from fe_contact.steppers.stacked import Stacked, side_of
from fe_contact.targets.base import MeshedTarget
from lumped.scene.geometry import Geometry
from lumped.scene.indenter import Indenter
from lumped.targets import Target
from lumped.targets.o_ring import ORing

Sizes = tuple[float, int, float, float, float]  # elements, order, smallest contact, contact, mean radius: see _body


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The O-ring at rest; ``radii``, m: distance from the top where the undeformed surfaces overlap."""
    target, sizes = _sizes(indenter.target, radii, LINE_REFINEMENT, numerics)
    surface = on_mesh(_body.recipe(*sizes), indenter.material.nu)
    places = target.section_radius * np.sin(surface.operator.points)
    return BodyStill.alone(surface, places, target.section_radius, indenter, numerics)


def solid(indenter: Indenter, radii: Array, numerics: Numerics) -> SolidMesh:
    """The same for large strains."""
    target, sizes = _sizes(indenter.target, radii, FINITE_REFINEMENT, numerics)
    return SolidMesh(_body(*sizes), target.section_radius, mean_radius=sizes[-1], ends=True, lead=target.lead)


def struck(geometry: Geometry, numerics: Numerics) -> Stacked:
    """The O-ring in an impact; its other half moves alike, so that both together are half as stiff as one."""
    return _stacked(geometry, _struck_sizes(geometry, numerics))


def relaxing(geometry: Geometry, numerics: Numerics) -> Stacked:
    """The same of constant bulk modulus."""
    return _stacked(geometry, _struck_sizes(geometry, numerics), Pace.of(numerics))


def _struck_sizes(geometry: Geometry, numerics: Numerics) -> Sizes:
    """For contacts that grow from nothing to the half-width that the settings expect."""
    radii = np.array(struck_ends(geometry.shape, numerics))
    return _sizes(geometry.target, radii, STRUCK_REFINEMENT, numerics)[1]


def _sizes(target: Target, radii: Array, refinement: float, numerics: Numerics) -> tuple[ORing, Sizes]:
    """The ring, and its mesh for contacts that end so far from the top, m; ``refinement``: elements over the usual."""
    assert isinstance(target, ORing)
    zone, mean_radius = Zone.round(radii, target.section_radius), target.mean_radius / target.section_radius
    elements = refinement * numerics.elements_per_contact
    return target, (elements, numerics.order, zone.smallest, zone.reference, mean_radius)


@cached
def _stacked(geometry: Geometry, sizes: Sizes, pace: Pace | None = None) -> Stacked:
    target = geometry.target
    assert isinstance(target, ORing)
    side = replace(side_of(_body.recipe(*sizes), geometry.material, geometry.shape, pace), share=target.lead)
    return Stacked(side.operator, (side,), target.section_radius)


@cached
def _body(elements: float, order: int, smallest: float, contact: float, mean_radius: float) -> ElasticBody:
    """In units of the section's radius, points and ``contact`` in rad from its top."""
    basis = basis_on(made(meshes.o_ring, elements, smallest, contact, mean_radius, order), order)
    fixed = held(basis, along=(), across=("base",))
    return ElasticBody.alone(basis, fixed, crown(basis, contact, mean_radius))


MEMBER = MeshedTarget(still, struck=struck, relaxing=relaxing, seconds=3.5, paired=True, solid=solid)
