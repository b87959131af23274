"""The homogeneous half-space: graded quarter disc, point-force far field, one operator for every scale."""

from __future__ import annotations

import meshes
from fe_contact.assembly.cache import kept
from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import made, surface_operator
from fe_contact.bodies.pressing import ScaledStill, Still
from fe_contact.settings import Numerics
from fe_contact.steppers.scaled_surface import ScaledSurface
from fe_contact.targets import _half_plane as half_plane
from fe_contact.targets import _rim as rim
from lumped.scene.geometry import Geometry
from lumped.scene.indenter import Indenter


def surface(poisson: float, numerics: Numerics) -> ScaledSurface:
    """Contact surface for these settings; made once a process, then shared by every impact that agrees."""
    return _surface(poisson, numerics.elements_per_contact, numerics.order, numerics.far_radius)


def struck(geometry: Geometry, numerics: Numerics) -> ScaledSurface:
    """The half-space in an impact, or the half-plane relative to its datum."""
    if geometry.shape.plane:
        return half_plane.struck(geometry, numerics)
    return surface(geometry.material.nu, numerics)


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The half-space at rest, or the half-plane relative to its datum; ``radii``: of the contacts, m."""
    if indenter.shape.plane:
        return half_plane.still(indenter, radii, numerics)
    if indenter.shape.fixed_radius is not None:
        return rim.still(indenter, indenter.shape.fixed_radius, numerics)
    return ScaledStill(surface(indenter.material.nu, numerics), indenter, numerics)


@kept
def _surface(poisson: float, elements: float, order: int, far_radius: float) -> ScaledSurface:
    return ScaledSurface(surface_operator(made(meshes.half_space, elements, far_radius), order, poisson))
