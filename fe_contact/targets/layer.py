"""The layer on a rigid foundation: one mesh that resolves every contact radius alike, the sides far away."""

from __future__ import annotations

from functools import lru_cache

from skfem import Basis

import meshes
from fe_contact.bodies.scaled_surface import ScaledSurface
from fe_contact.forms import Array, isotropic, plane_stiffness, stiffness
from fe_contact.numerics import Numerics
from fe_contact.operators import ELEMENTS, condensed
from fe_contact.pressing import FixedStill, Still
from fe_contact.surface import flat
from fe_contact.targets._zone import REFINEMENT, Zone, held
from lumped.indenter import Indenter
from lumped.scene import Geometry
from lumped.targets.layer import Layer

SMALLEST_STRUCK = 0.04  # contact radius over the largest one, below which an impact's elements grow no finer
SIDES = 0.4  # distance of the sides in thicknesses, per far radius of the settings


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The layer at rest; ``radii``, m: where the undeformed surfaces overlap at the depths to come."""
    target = indenter.target
    assert isinstance(target, Layer)
    zone = Zone.of(indenter.shape, radii)
    surface = _surface(
        indenter.material.nu,
        REFINEMENT * numerics.elements_per_contact,
        numerics.order,
        zone.smallest,
        target.thickness / zone.reference,
        SIDES * numerics.far_radius * target.thickness / zone.reference,
        target.base == "bonded",
        indenter.shape.plane,
    )
    return FixedStill(surface, indenter, numerics, zone.reference, zone.reference)


def struck(geometry: Geometry, numerics: Numerics) -> ScaledSurface:
    """The layer in an impact whose contact grows from nothing to the radius that the settings expect."""
    target = geometry.target
    assert isinstance(target, Layer)
    reference = numerics.contact_radius
    return _surface(
        geometry.material.nu,
        REFINEMENT * numerics.elements_per_contact,
        numerics.order,
        1.0 if geometry.shape.fixed_radius is not None else SMALLEST_STRUCK,
        target.thickness / reference,
        SIDES * numerics.far_radius * target.thickness / reference,
        target.base == "bonded",
        geometry.shape.plane,
    )


@lru_cache(maxsize=32)
def _surface(
    poisson: float,
    elements: float,
    order: int,
    smallest: float,
    thickness: float,
    width: float,
    bonded: bool,
    plane: bool,
) -> ScaledSurface:
    """Condensed for unit reference radius; the sides are held in the radial direction."""
    basis = Basis(meshes.layer(elements, smallest, thickness, width), ELEMENTS[order](), intorder=2 * order)
    law = isotropic(1.0 - poisson**2, poisson)
    matrix = plane_stiffness(basis, law) if plane else stiffness(basis, law)
    fixed = held(basis, along=("axis", "side", "base") if bonded else ("axis", "side"), across=("base",))
    operator = condensed(basis, matrix.tocsc(), fixed, poisson, flat(basis, 2 if plane else 3))
    return ScaledSurface(operator, breathes=False)
