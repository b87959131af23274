"""The homogeneous half-space: graded quarter disc, point-force far field, one operator for every scale.

The half-space under a flat end, whose rim no depth moves: the mesh is as fine there as the pressure is steep.

The half-plane struck by a cylinder: depth relative to the point at the datum.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import scipy.sparse as sparse

import meshes
from fe_contact.assembly.cache import cached, cached_surface
from fe_contact.assembly.disk_cache import on_disk
from fe_contact.assembly.forms import Array, Basis, Matrix
from fe_contact.assembly.operators import (
    ElasticBody,
    SolidMesh,
    SurfaceOperator,
    WholeBody,
    basis_on,
    condensed,
    made,
    system_matrix,
)
from fe_contact.assembly.surface import face, flat, lagrange
from fe_contact.bodies.pressing import (
    FINITE_MARGIN,
    FINITE_REFINEMENT,
    LINE_REFINEMENT,
    REFINEMENT,
    STRUCK_REFINEMENT,
    FixedStill,
    ScaledStill,
    Still,
    Zone,
    held,
    smallest_struck,
)
from fe_contact.settings import Numerics
from fe_contact.steppers.scaled_surface import ScaledSurface
from fe_contact.targets.base import MeshedTarget
from lumped.scene.geometry import Geometry
from lumped.scene.indenter import Indenter
from lumped.targets import HalfSpace, Target
from meshes.half_space import WAVE_GROWTH

FINER = 2.0  # elements at the surface over those which the growth into the body is for, where strains are large
ENDS = ("base", "side")  # of a box of it
# Half-plane of large strains: what goes as their square leaves an error of first order in the size, so that its size
# goes as the square of the setting, and is the same as at small strains where that is least.
FARTHER = 0.5
FARTHEST = 5e3  # that size over the setting at most, unless small strains ask for more: strains are rounding there
DATUM = 0.6  # size of the mesh over the datum's depth, per far radius of the settings, which is 2 at least


def surface(poisson: float, numerics: Numerics) -> ScaledSurface:
    """Contact surface for these settings; made once a process, then shared by every impact that agrees."""
    return _surface(poisson, numerics.elements_per_contact, numerics.order, numerics.far_radius)


def whole(geometry: Geometry, numerics: Numerics) -> WholeBody:
    """The same with its inside."""
    return _whole(geometry.material.nu, numerics.elements_per_contact, numerics.order, numerics.far_radius)


def struck(geometry: Geometry, numerics: Numerics) -> ScaledSurface:
    """The half-space in an impact, or the half-plane relative to its datum."""
    if geometry.shape.plane:
        return _plane_struck(geometry, numerics)
    return surface(geometry.material.nu, numerics)


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The half-space at rest, or the half-plane relative to its datum; ``radii``: of the contacts, m."""
    if indenter.shape.plane:
        return _plane_still(indenter, radii, numerics)
    if indenter.shape.fixed_radius is not None:
        return under_rim(indenter, indenter.shape.fixed_radius, numerics)
    return ScaledStill(surface(indenter.material.nu, numerics), indenter, numerics, float(radii.min()))


@cached_surface
def _surface(poisson: float, elements: float, order: int, far_radius: float) -> ScaledSurface:
    return ScaledSurface(_operator(poisson, elements, order, far_radius))


@on_disk
def _operator(poisson: float, elements: float, order: int, far_radius: float) -> SurfaceOperator:
    return _whole(poisson, elements, order, far_radius).operator


def _whole(poisson: float, elements: float, order: int, far_radius: float) -> WholeBody:
    """Condensed for contact radius one. Raises BodyTooFine for more unknowns than is bearable."""
    basis = basis_on(made(meshes.half_space, elements, far_radius), order)
    fixed = 2 * basis.get_dofs("axis").flatten()
    return condensed(basis, system_matrix(basis, poisson), fixed, poisson, flat(basis))


def under_rim(indenter: Indenter, radius: float, numerics: Numerics) -> Still:
    """The half-space at rest under an end of this radius, m."""
    elements = REFINEMENT * numerics.elements_per_contact
    surface = _rimmed(indenter.material.nu, elements, numerics.order, numerics.far_radius)
    return FixedStill(surface, indenter, numerics, radius, radius, np.inf)


@cached_surface
def _rimmed(poisson: float, elements: float, order: int, far_radius: float) -> ScaledSurface:
    return ScaledSurface(_rimmed_operator(poisson, elements, order, far_radius), follows_contact=False)


@on_disk
def _rimmed_operator(poisson: float, elements: float, order: int, far_radius: float) -> SurfaceOperator:
    """Condensed for unit radius."""
    basis = basis_on(made(meshes.layer_under_rim, elements, far_radius, far_radius), order)
    matrix, fixed = system_matrix(basis, poisson, ENDS), held(basis, along=("axis",), across=())
    return condensed(basis, matrix, fixed, poisson, face(basis, 1.0)).operator


def _plane_still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The half-plane at rest; ``radii``, m: between which the contacts will end."""
    zone = Zone.of(radii)
    elements, depth = LINE_REFINEMENT * numerics.elements_per_contact, _datum(indenter.target) / zone.reference
    size = numerics.far_radius * _least_size(depth)
    surface = _plane_surface(indenter.material.nu, elements, numerics.order, zone.smallest, depth, size)
    return FixedStill(surface, indenter, numerics, zone.reference, zone.reference, np.inf)


def _plane_struck(geometry: Geometry, numerics: Numerics) -> ScaledSurface:
    """The half-plane in an impact whose contact grows from nothing to the half-width that the settings expect."""
    depth = _datum(geometry.target) / numerics.contact_radius
    elements, size = STRUCK_REFINEMENT * numerics.elements_per_contact, numerics.far_radius * _least_size(depth)
    return _plane_surface(geometry.material.nu, elements, numerics.order, smallest_struck(geometry.shape), depth, size)


@cached_surface
def _plane_surface(
    poisson: float, elements: float, order: int, smallest: float, datum: float, size: float
) -> ScaledSurface:
    return ScaledSurface(_plane_operator(poisson, elements, order, smallest, datum, size), follows_contact=False)


@on_disk
def _plane_operator(
    poisson: float, elements: float, order: int, smallest: float, datum: float, size: float
) -> SurfaceOperator:
    """Condensed for unit reference radius; the datum's motion upwards is watched."""
    basis = basis_on(made(meshes.layer, elements, smallest, size, size), order)
    matrix, fixed = system_matrix(basis, poisson, ENDS, plane=True), held(basis, along=("axis",), across=())
    return condensed(basis, matrix, fixed, poisson, flat(basis, 2), _upwards(basis, datum)).operator


def _datum(target: Target) -> float:
    """How far below touch it lies, m."""
    assert isinstance(target, HalfSpace)
    assert target.datum_depth is not None
    return target.datum_depth


def _least_size(datum: float) -> float:
    """Of a mesh in which a datum so far down lies, per far radius of the settings; lengths in contact radii."""
    return max(1.0, DATUM * datum)


def _upwards(basis: Basis, depth: float) -> Matrix:
    """Weights of the displacement upwards at a depth on the plane of symmetry, sparse (1, 2 N)."""
    order, dofs = basis.elem.maxdeg, basis.get_dofs("axis").flatten()
    dofs = dofs[np.argsort(-basis.doflocs[1, dofs])]
    corners = -basis.doflocs[1, dofs[::order]]
    facet = int(np.searchsorted(corners, depth)) - 1
    share = (depth - corners[facet]) / (corners[facet + 1] - corners[facet])
    members = dofs[order * facet : order * (facet + 1) + 1]
    entries = (lagrange(np.array([share]), order)[0], (np.zeros_like(members), 2 * members + 1))
    return sparse.csr_matrix(entries, shape=(1, 2 * basis.N))


def solid(indenter: Indenter, radii: Array, numerics: Numerics) -> SolidMesh:
    """The half-space for large strains, on one mesh for all contacts; ``radii`` expected of them, m."""
    if indenter.shape.plane:
        return _plane_solid(indenter, radii, numerics)
    zone = Zone.of(radii, FINITE_MARGIN, indenter.profile.flat_radius)
    elements = FINITE_REFINEMENT * numerics.elements_per_contact
    body = _solid(elements, (zone.smallest, zone.flat, zone.beside), numerics.far_radius, numerics.order)
    return SolidMesh(body, zone.reference)


@cached
def _solid(elements: float, ends: tuple[float, float, float], far_radius: float, order: int) -> ElasticBody:
    """In units of the reference radius."""
    smallest, rim, beside = ends
    mesh = made(meshes.half_space_for_waves, elements / FINER, smallest, far_radius, FINER, WAVE_GROWTH, rim, beside)
    basis = basis_on(mesh, order)
    return ElasticBody(basis, partial(_stiffness, basis), 2 * basis.get_dofs("axis").flatten(), flat(basis))


def _stiffness(
    basis: Basis, bulk: float, shear: float, ends: tuple[str, ...] = ("far",), plane: bool = False
) -> Matrix:
    """Of body and far field, of any modulus, (2 N, 2 N)."""
    modulus = 4.0 * shear * (3.0 * bulk + shear) / (3.0 * bulk + 4.0 * shear)
    return modulus * system_matrix(basis, (1.5 * bulk - shear) / (3.0 * bulk + shear), ends, plane)


def _plane_solid(indenter: Indenter, radii: Array, numerics: Numerics) -> SolidMesh:
    """The half-plane for large strains, relative to its datum."""
    zone = Zone.of(radii, FINITE_MARGIN)
    elements, depth = FINITE_REFINEMENT * numerics.elements_per_contact, _datum(indenter.target) / zone.reference
    least = _least_size(depth)
    size = numerics.far_radius * max(min(FARTHER * numerics.far_radius * least, FARTHEST), least)
    body = _plane_body(elements, numerics.order, zone.smallest, size)
    return SolidMesh(body, zone.reference, datum=_upwards(body.basis, depth))


@cached
def _plane_body(elements: float, order: int, smallest: float, size: float) -> ElasticBody:
    """In units of the reference radius."""
    basis = basis_on(made(meshes.layer, elements, smallest, size, size), order)

    def matrix(bulk: float, shear: float) -> Matrix:
        return _stiffness(basis, bulk, shear, ENDS, plane=True)

    return ElasticBody(basis, matrix, held(basis, along=("axis",), across=()), flat(basis, 2))


MEMBER = MeshedTarget(still, struck=struck, whole=whole, seconds=0.1, solid=solid)
