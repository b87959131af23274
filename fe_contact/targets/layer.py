"""The layer on a rigid foundation: one mesh that resolves every contact radius alike, the sides far away."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from skfem import Basis

import meshes
from fe_contact.bodies.scaled_surface import ScaledSurface
from fe_contact.forms import Array, isotropic, stiffness
from fe_contact.numerics import Numerics
from fe_contact.operators import ELEMENTS, condensed
from fe_contact.pressing import FixedStill, Still
from lumped.indenter import Indenter
from lumped.targets.layer import Layer

REFINEMENT = 4.0  # elements along a contact radius where the contact may end anywhere, over those where it may not
LARGEST, SMALLEST = 1.6, 0.6  # contact radius over the one at which the undeformed surfaces overlap, in any layer
SIDES = 0.4  # distance of the sides in thicknesses, per far radius of the settings


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The layer at rest; ``radii``, m: where the undeformed surfaces overlap at the depths to come."""
    target = indenter.target
    assert isinstance(target, Layer)
    profile = indenter.profile
    reference = profile.fixed_radius or LARGEST * float(radii.max())
    smallest = 1.0 if profile.fixed_radius else min(SMALLEST * float(radii.min()) / reference, 1.0)
    elements = REFINEMENT * numerics.elements_per_contact
    width = SIDES * numerics.far_radius * target.thickness / reference
    surface = _surface(
        indenter.material.nu, elements, numerics.order, smallest, target.thickness / reference, width, target.base
    )
    return FixedStill(surface, profile, numerics, reference)


@lru_cache(maxsize=32)
def _surface(
    poisson: float, elements: float, order: int, smallest: float, thickness: float, width: float, base: str
) -> ScaledSurface:
    """Condensed for unit reference radius; the sides are held in the radial direction."""
    basis = Basis(meshes.layer(elements, smallest, thickness, width), ELEMENTS[order](), intorder=2 * order)
    held = {name: basis.get_dofs(name).flatten() for name in ("axis", "base", "side")}
    fixed = [2 * held["axis"], 2 * held["base"] + 1, 2 * held["side"]]
    if base == "bonded":
        fixed.append(2 * held["base"])
    matrix = stiffness(basis, isotropic(1.0 - poisson**2, poisson)).tocsc()
    return ScaledSurface(condensed(basis, matrix, np.unique(np.concatenate(fixed)), poisson))
