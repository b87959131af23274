"""The ring, held outside, struck from inside: half of it laid flat, with its exact arcs in the strain."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from skfem import Basis

import meshes
from fe_contact.bodies.scaled_surface import ScaledSurface
from fe_contact.forms import Array, isotropic, polar_stiffness
from fe_contact.numerics import Numerics
from fe_contact.operators import ELEMENTS, condensed
from fe_contact.pressing import FixedStill, Still
from fe_contact.surface import flat
from fe_contact.targets._zone import LINE_REFINEMENT, MARGIN, STRUCK_REFINEMENT, Zone, held, smallest_struck
from lumped.indenter import Indenter
from lumped.scene import Geometry
from lumped.targets.ring import Ring

WIDEST = 2.7  # rad: the contact zone ends before the far side of the ring


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The ring at rest; ``radii``, m of arc: between which the contacts will end.

    The whole ring is meshed, so that there is no far field.
    """
    target = indenter.target
    assert isinstance(target, Ring)
    zone = Zone.of(np.minimum(radii, WIDEST / MARGIN * target.inner_radius))
    angle, thickness = zone.reference / target.inner_radius, target.thickness / zone.reference
    elements = LINE_REFINEMENT * numerics.elements_per_contact
    surface = _surface(indenter.material.nu, elements, numerics.order, zone.smallest, thickness, angle)
    return FixedStill(surface, indenter, numerics, zone.reference, angle, thickness)


def struck(geometry: Geometry, numerics: Numerics) -> ScaledSurface:
    """The ring in an impact whose contact grows from nothing to the arc that the settings expect."""
    target = geometry.target
    assert isinstance(target, Ring)
    reference = min(numerics.contact_radius, WIDEST * target.inner_radius)
    elements = STRUCK_REFINEMENT * numerics.elements_per_contact
    angle, thickness = reference / target.inner_radius, target.thickness / reference
    return _surface(geometry.material.nu, elements, numerics.order, smallest_struck(geometry.shape), thickness, angle)


@lru_cache(maxsize=32)
def _surface(
    poisson: float, elements: float, order: int, smallest: float, thickness: float, angle: float
) -> ScaledSurface:
    """Condensed for a contact zone of unit arc length, which spans ``angle``, rad; ``thickness`` in its units."""
    mesh = meshes.ring(elements, smallest, thickness, math.pi / angle)
    basis = Basis(mesh, ELEMENTS[order](), intorder=2 * order)
    matrix = polar_stiffness(basis, isotropic(1.0 - poisson**2, poisson), 1.0 / angle).tocsc()
    fixed = held(basis, along=("axis", "side", "base"), across=("base",))
    surface = flat(basis, 2, lambda place: np.cos(angle * place))
    return ScaledSurface(condensed(basis, matrix, fixed, poisson, surface), breathes=False)
