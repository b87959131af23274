"""The washer under a flat end: its section, graded to the rim of the punch and to the corners of a bonded base."""

from __future__ import annotations

import numpy as np
from skfem import Basis

import meshes
from fe_contact.contact import PressedSurface
from fe_contact.forms import Array, isotropic, stiffness
from fe_contact.kept import kept
from fe_contact.numerics import Numerics
from fe_contact.operators import ELEMENTS, SurfaceOperator, condensed
from fe_contact.pressing import Still
from fe_contact.surface import Surface, ring_area
from fe_contact.targets._body import BodyStill
from fe_contact.targets._zone import held, thickness_over
from lumped.indenter import Indenter
from lumped.targets.washer import Washer

COARSER = 0.75  # elements along the shortest length over those along a contact that may end anywhere


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The washer at rest; ``radii``, m: where the contact ends, alike at every depth."""
    target = indenter.target
    assert isinstance(target, Washer)
    thickness_over(2.0 * (target.outer_radius - target.inner_radius), target.height)  # fine from both of its ends
    inner, outer, rim = (length / target.height for length in (target.inner_radius, target.outer_radius, radii.max()))
    elements, bonded = COARSER * numerics.elements_per_contact, target.base == "bonded"
    operator, surface = _surface(indenter.material.nu, elements, numerics.order, inner, outer, rim, bonded)
    return BodyStill(
        surface=surface,
        operator=operator,
        places=target.height * operator.points,
        scale=target.height,
        indenter=indenter,
        numerics=numerics,
        degrees_of_freedom=operator.degrees_of_freedom,
    )


@kept
def _surface(
    poisson: float, elements: float, order: int, inner: float, outer: float, rim: float, bonded: bool
) -> tuple[SurfaceOperator, PressedSurface]:
    """Condensed for unit height, loaded up to the rim alone."""
    basis = Basis(meshes.washer(elements, inner, outer, rim, bonded), ELEMENTS[order](), intorder=2 * order)
    matrix = stiffness(basis, isotropic(1.0 - poisson**2, poisson)).tocsc()
    fixed = held(basis, along=("base",) if bonded else (), across=("base",))
    dofs = basis.get_dofs("surface").flatten()
    dofs = dofs[np.argsort(basis.doflocs[0, dofs])]
    surface = Surface(
        dofs=dofs,
        coordinate=basis.doflocs[0, dofs],
        normal=np.tile([0.0, 1.0], (dofs.size, 1)),
        measure=ring_area,
        motion=np.ones_like,
        zone=rim * (1.0 - 1e-12),
        dimension=3,
    )
    operator = condensed(basis, matrix, fixed, poisson, surface)
    return operator, PressedSurface(operator.stiffness, operator.trace, operator.weights, recurring=False)
