"""The half-plane struck by a cylinder: depth relative to the point at the datum."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sparse
from skfem import FacetBasis

import meshes
from fe_contact.assembly import half_plane
from fe_contact.assembly.cache import kept
from fe_contact.assembly.forms import Array, Basis, Matrix, isotropic, plane_stiffness
from fe_contact.assembly.operators import basis_on, condensed, made
from fe_contact.assembly.surface import flat
from fe_contact.assembly.trace import lagrange
from fe_contact.bodies.pressing import FixedStill, Still
from fe_contact.bodies.zone import LINE_REFINEMENT, STRUCK_REFINEMENT, Zone, held, smallest_struck
from fe_contact.settings import Numerics
from fe_contact.steppers.scaled_surface import ScaledSurface
from lumped.scene.geometry import Geometry
from lumped.scene.indenter import Indenter

DATUM = 0.15  # size of the mesh over the datum's depth, per far radius of the settings


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The half-plane at rest; ``radii``, m: between which the contacts will end."""
    datum, zone = getattr(indenter.target, "datum_depth", None), Zone.of(radii)
    assert datum is not None
    elements, depth = LINE_REFINEMENT * numerics.elements_per_contact, datum / zone.reference
    size = numerics.far_radius * max(1.0, DATUM * depth)
    surface = _surface(indenter.material.nu, elements, numerics.order, zone.smallest, depth, size)
    return FixedStill(surface, indenter, numerics, zone.reference, zone.reference, np.inf)


def struck(geometry: Geometry, numerics: Numerics) -> ScaledSurface:
    """The half-plane in an impact whose contact grows from nothing to the half-width that the settings expect."""
    datum = getattr(geometry.target, "datum_depth", None)
    assert datum is not None
    depth = datum / numerics.contact_radius
    elements, size = STRUCK_REFINEMENT * numerics.elements_per_contact, numerics.far_radius * max(1.0, DATUM * depth)
    return _surface(geometry.material.nu, elements, numerics.order, smallest_struck(geometry.shape), depth, size)


@kept
def _surface(poisson: float, elements: float, order: int, smallest: float, datum: float, size: float) -> ScaledSurface:
    """Condensed for unit reference radius; the datum's motion upwards is watched."""
    basis = basis_on(made(meshes.layer, elements, smallest, size, size), order)
    ends = [basis.mesh.boundaries[name] for name in ("base", "side")]
    outside = FacetBasis(basis.mesh, basis.elem, facets=np.concatenate(ends), intorder=2 * order + 4)
    law = isotropic(1.0 - poisson**2, poisson)
    matrix = (plane_stiffness(basis, law) + half_plane.robin(outside, poisson)).tocsc()
    fixed = held(basis, along=("axis",), across=())
    operator = condensed(basis, matrix, fixed, poisson, flat(basis, 2), _upwards(basis, datum))
    return ScaledSurface(operator, breathes=False)


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
