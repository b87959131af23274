"""The O-ring between two planes: the upper half of its section, which a contact may cover on both sides of its top."""

from __future__ import annotations

import numpy as np
from skfem import Basis

import meshes
from fe_contact.bodies.stacked import Side, Stacked
from fe_contact.contact import PressedSurface
from fe_contact.forms import Array, isotropic, stiffness
from fe_contact.kept import kept
from fe_contact.numerics import Numerics
from fe_contact.operators import ELEMENTS, SurfaceOperator, condensed
from fe_contact.pressing import Still
from fe_contact.surface import crown
from fe_contact.targets._body import BodyStill
from fe_contact.targets._zone import (
    LINE_REFINEMENT,
    MARGIN,
    STRUCK_REFINEMENT,
    Zone,
    held,
    smallest_struck,
)
from lumped.geometry import Geometry
from lumped.indenter import Indenter
from lumped.targets.o_ring import ORing


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The O-ring at rest; ``radii``, m: distance from the top where the undeformed surfaces overlap."""
    target = indenter.target
    assert isinstance(target, ORing)
    zone = Zone.round(radii, target.section_radius)
    operator, surface = _surface(
        indenter.material.nu,
        LINE_REFINEMENT * numerics.elements_per_contact,
        numerics.order,
        zone.smallest,
        zone.reference,
        target.mean_radius / target.section_radius,
    )
    return BodyStill(
        surface=surface,
        operator=operator,
        places=target.section_radius * np.sin(operator.points),
        scale=target.section_radius,
        indenter=indenter,
        numerics=numerics,
        degrees_of_freedom=operator.degrees_of_freedom,
    )


def struck(geometry: Geometry, numerics: Numerics) -> Stacked:
    """The O-ring in an impact; its other half moves alike, so that both together are half as stiff as one."""
    elements = STRUCK_REFINEMENT * numerics.elements_per_contact
    return _struck(geometry, elements, numerics.order, numerics.contact_radius / MARGIN)


@kept
def _struck(geometry: Geometry, elements: float, order: int, largest: float) -> Stacked:
    """For contacts up to a half-width, m."""
    target = geometry.target
    assert isinstance(target, ORing)
    section = target.section_radius
    zone = Zone.round(largest * np.array([smallest_struck(geometry.shape), 1.0]), section)
    sizes = (elements, order, zone.smallest, zone.reference, target.mean_radius / section)
    operator, _ = _surface(geometry.material.nu, *sizes)
    relaxation = geometry.shape.modulus(geometry.material)
    return Stacked(operator, (Side(operator, relaxation, operator.trace, target.lead),), section)


@kept
def _surface(
    poisson: float, elements: float, order: int, smallest: float, contact: float, mean_radius: float
) -> tuple[SurfaceOperator, PressedSurface]:
    """Condensed for unit radius of the section, points and ``contact`` in rad from its top."""
    basis = Basis(meshes.o_ring(elements, smallest, contact, mean_radius), ELEMENTS[order](), intorder=2 * order)
    matrix = stiffness(basis, isotropic(1.0 - poisson**2, poisson)).tocsc()
    fixed = held(basis, along=(), across=("base",))
    operator = condensed(basis, matrix, fixed, poisson, crown(basis, contact, mean_radius))
    return operator, PressedSurface(operator.stiffness, operator.trace, operator.weights, recurring=False)
