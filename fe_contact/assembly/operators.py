"""Mesh and material -> matrices, and what the contact surface knows of the body: one condensed operator.

A body is its mesh with its supports, for any isotropic material: a new Poisson's ratio needs no new mesh.
Assembled and factorised once; a unit force on every surface degree of freedom gives the compliance
``C = B K^-1 B^T``. All quantities are for contact radius 1 and contact modulus E* = 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.cache import Recipe
from fe_contact.assembly.disk_cache import on_disk
from fe_contact.assembly.far_field import plane_robin, robin
from fe_contact.assembly.forms import Array, Basis, Indices, Matrix, elastic, isotropic, stiffness
from fe_contact.assembly.interior import Floating, Interior
from fe_contact.assembly.surface import Surface, trace_between
from fe_contact.errors import BodyTooFine
from meshes.errors import MeshTooLarge

if TYPE_CHECKING:
    from skfem import Element

MOST_UNKNOWNS = 200_000  # of one body: its factors take a gigabyte and half a minute
SOLVED_AT_ONCE = 32  # right-hand sides: more of them leave the processor's cache


@dataclass(frozen=True, eq=False)
class SurfaceOperator:
    """A body seen through its surface, in units of contact radius and contact modulus: all that an impact asks of it.

    ``nodes`` (n_s,) radii, or coordinates, of all surface nodes, sorted, ``order`` of them a facet plus one;
    ``stiffness`` (n, n) condensed normal stiffness of the n first nodes, those in the contact zone;
    ``response`` (n_s, n) normal displacement of all surface nodes under unit nodal forces there;
    ``points``, ``weights`` (q,) quadrature of the contact zone, weights including 2 pi r; ``pull`` (q,) of them
    what counts for the force along the motion;
    ``trace`` (q, n) displacement at the points from that of the nodes;
    ``poisson`` its Poisson's ratio; ``dimension`` as of :class:`Surface`;
    ``watched`` (n,) how far the place from which depth is measured comes up under unit nodal forces on the zone, None
    where it is at rest; ``degrees_of_freedom``: unknowns of the finite-element system behind the surface.
    """

    nodes: Array
    order: int
    stiffness: Array
    response: Array
    points: Array
    weights: Array
    pull: Array
    trace: Array
    poisson: float
    dimension: int
    watched: Array | None
    degrees_of_freedom: int

    def force(self, scale: float, pressure: Array) -> float:
        """Force along the motion of a unit-mesh pressure (q,) on the mesh scaled by ``scale``."""
        return float(scale ** (self.dimension - 2) * (self.pull @ pressure))

    def punched(self, radius: float) -> Array:
        """Nodal forces (m,) of a flat end pressed in by one, on the m nodes up to a radius."""
        reached = min(max(int(np.searchsorted(self.nodes, radius)), self.order + 1), len(self.stiffness))
        forces = np.asarray(np.linalg.solve(self.response[:reached, :reached], np.ones(reached)))
        return forces if self.watched is None else forces / (1.0 + self.watched[:reached] @ forces)

    @property
    def compliance(self) -> Array:
        """Displacement of the zone's nodes relative to that place under unit nodal forces there, (n, n)."""
        own = self.response[: len(self.stiffness)]
        return own if self.watched is None else own + self.watched

    @property
    def corners(self) -> Array:
        """Ends of the facets in the contact zone, ascending."""
        return self.nodes[: self.trace.shape[1] : self.order]

    def projected(self, pressure: Array) -> Array:
        """Nodal values (n,) whose moments against the shape functions are those of a pressure (q,)."""
        return self._projected(self.trace, pressure)

    def hats(self, pressure: Array) -> Array:
        """Values at the corners of the facets, whose moments against the hats there are those of a pressure (q,)."""
        return self._projected(self.hat_shapes, pressure)

    @cached_property
    def hat_shapes(self) -> Array:
        """The hats at the points, (q, corners)."""
        return trace_between(self.corners, self.points, 1)

    def _projected(self, trace: Array, pressure: Array) -> Array:
        mass = trace.T @ (self.weights[:, None] * trace)
        return np.asarray(np.linalg.solve(mass, trace.T @ (self.weights * pressure)))

    @property
    def yielding(self) -> float | Array:
        """How far the place from which depth is measured comes up under unit forces at the points, (q,) or 0."""
        return 0.0 if self.watched is None else np.asarray(self.trace @ self.watched)


@dataclass(frozen=True, eq=False)
class WholeBody:
    """A condensed body with its inside: the ``operator`` of its surface and the scalar scikit-fem ``basis``.

    ``solve`` maps nodal forces (n,) on the zone to the displacement of the whole mesh (2 N,), factorising anew.
    """

    operator: SurfaceOperator
    basis: Basis
    solve: Interior


def made(make: Callable[..., Any], *numbers: object) -> Any:
    """The mesh that numbers make; raises BodyTooFine where it would be too large."""
    try:
        return make(*numbers)
    except MeshTooLarge as failure:
        raise BodyTooFine(failure.what, "its size is estimated first") from failure


def element(order: int) -> Element:
    """The triangle of scikit-fem of an order, 1 to 4."""
    import skfem  # late: a body that is known already needs none

    return (skfem.ElementTriP1, skfem.ElementTriP2, skfem.ElementTriP3, skfem.ElementTriP4)[order - 1]()


def basis_on(mesh: Any, order: int) -> Basis:
    """Scalar scikit-fem basis of an element order, 1 to 4; raises BodyTooFine for more unknowns than is bearable."""
    from skfem import CellBasis

    unknowns = 2 * order**2 * int(mesh.nvertices)
    if unknowns > MOST_UNKNOWNS:
        raise BodyTooFine(f"a body of {unknowns} unknowns", f"accepted up to {MOST_UNKNOWNS}")
    return CellBasis(mesh, element(order), intorder=2 * order)


def condensed(
    basis: Basis,
    matrix: Matrix,
    fixed: Indices,
    poisson: float,
    surface: Surface,
    watch: Matrix = None,
    floating: Floating | None = None,
) -> WholeBody:
    """Factorise the stiffness of a body once and condense it to its contact zone.

    Parameters
    ----------
    basis : scalar scikit-fem basis with N functions.
    matrix : stiffness for E* = 1, sparse (2 N, 2 N).
    fixed : degrees of freedom held at zero.
    poisson : Poisson's ratio.
    surface : where contact may happen, in units of the mesh.
    watch : weights of the displacement of the place from which depth is measured, (1, 2 N); None: it is at rest.
    floating : of a body whose inertia alone balances the load; ``fixed`` then holds it at one point too.
    """
    loaded = surface.loaded(basis.elem.maxdeg)
    normal = normals(surface, matrix.shape[0])
    free = np.setdiff1d(np.arange(matrix.shape[0]), fixed)
    interior = Interior(matrix[free][:, free], free, normal[:, :loaded], floating)
    response, watched = _influence(interior.factorised(), normal, watch, loaded)
    return WholeBody(seen_through(basis, surface, poisson, response, watched), basis, interior)


def seen_through(
    basis: Basis, surface: Surface, poisson: float, response: Array, watched: Array | None = None
) -> SurfaceOperator:
    """The operator of a body whose response (n_s, n), and what is watched (n,), are known; see its fields."""
    order = basis.elem.maxdeg
    points, weights, trace = surface.quadrature(order)
    compliance = response[: trace.shape[1]]
    condensed = np.linalg.inv((compliance + compliance.T) / 2)
    return SurfaceOperator(
        nodes=surface.coordinate,
        order=order,
        stiffness=(condensed + condensed.T) / 2,
        response=response,
        points=points,
        weights=weights,
        pull=weights * surface.motion(points),
        trace=trace,
        poisson=poisson,
        dimension=surface.dimension,
        watched=watched,
        degrees_of_freedom=2 * int(basis.N),
    )


def _influence(
    displacement: Callable[[Array], Array], normal: Matrix, watch: Matrix, loaded: int
) -> tuple[Array, Array | None]:
    """Inward displacement of the surface nodes, (n_s, loaded), and of what is watched, (loaded,), under unit forces."""
    seen = -normal.T if watch is None else sparse.vstack([-normal.T, watch])
    known, surface = np.empty((seen.shape[0], loaded)), normal.shape[1]
    forces = np.eye(loaded)
    for some in np.array_split(np.arange(loaded), -(-loaded // SOLVED_AT_ONCE)):
        known[:, some] = seen @ displacement(forces[:, some])
    return known[:surface], None if watch is None else known[surface]


def normals(surface: Surface, size: int) -> sparse.csc_matrix:
    """Unit normals of the surface nodes as columns, sparse (2 N, n_s)."""
    columns = np.arange(surface.dofs.size)
    rows = np.concatenate([2 * surface.dofs, 2 * surface.dofs + 1])
    entries = (surface.normal.T.ravel(), (rows, np.tile(columns, 2)))
    return sparse.csc_matrix(entries, shape=(size, columns.size))


def system_matrix(basis: Basis, poisson: float, ends: tuple[str, ...] = ("far",), plane: bool = False) -> Matrix:
    """Stiffness of body and far field for E* = 1, sparse (2 N, 2 N); the axis is not yet fixed.

    ``ends``: boundaries beyond which the half-space goes on, or, in plane strain, the half-plane.
    """
    outside = (plane_robin if plane else robin)(boundary(basis, ends), poisson)
    return (stiffness(basis, isotropic(1 - poisson**2, poisson), plane) + outside).tocsc()


def boundary(basis: Basis, ends: tuple[str, ...]) -> Basis:
    """Scalar facet basis of boundaries of a mesh."""
    from skfem import FacetBasis

    facets = np.concatenate([basis.mesh.boundaries[name] for name in ends])
    return FacetBasis(basis.mesh, basis.elem, facets=facets)


@dataclass(frozen=True, eq=False)
class ElasticBody:
    """``basis`` scalar scikit-fem basis with N functions; ``stiffness`` sparse (2 N, 2 N), of bulk and shear modulus.

    ``fixed`` degrees of freedom held at zero; ``surface`` where contact may happen. What lies beyond the mesh is part
    of the stiffness, hence linear in both moduli too. ``floating``: of a body that nothing holds but its inertia.
    """

    basis: Basis
    stiffness: Callable[[float, float], Matrix]
    fixed: Indices
    surface: Surface
    floating: Floating | None = None

    @classmethod
    def alone(
        cls, basis: Basis, fixed: Indices, surface: Surface, plane: bool = False, floating: Floating | None = None
    ) -> ElasticBody:
        """A body that ends with its mesh, of revolution or in ``plane`` strain."""

        def matrix(bulk: float, shear: float) -> Matrix:
            return stiffness(basis, elastic(bulk, shear), plane)

        return cls(basis, matrix, fixed, surface, floating)

    def condensed(self, poisson: float) -> WholeBody:
        """With this Poisson's ratio, for E* = 1; see :func:`condensed`."""
        matrix = self.stiffness(*moduli(poisson)).tocsc()
        return condensed(self.basis, matrix, self.fixed, poisson, self.surface, floating=self.floating)


@dataclass(frozen=True, eq=False)
class SolidMesh:
    """A ``body`` for large strains, whose unit is ``unit``, m; ``inner_radius`` of a ring laid flat, in that unit.

    ``mean_radius``, in that unit, of a ring of round section, whose surface counts angles from its top; ``covered``:
    whether a plane touches all of the surface from the first; ``ends``: whether the mesh is all of it; ``lead``: share
    of a depth that is pressed here, half of it where both sides are alike; ``sharp``: whether it has corners between a
    held and a free side, where stresses are infinite; ``datum``, sparse (1, 2 N): how far the place comes up from which
    depth is measured, None where that is at rest.
    """

    body: ElasticBody
    unit: float
    inner_radius: float | None = None
    mean_radius: float | None = None
    covered: bool = False
    ends: bool = False
    lead: float = 1.0
    sharp: bool = False
    datum: Matrix | None = None


@on_disk
def operator_of(body: Recipe[ElasticBody], poisson: float) -> SurfaceOperator:
    """What the contact surface knows of a body with this Poisson's ratio, for E* = 1."""
    return body.follow().condensed(poisson).operator


def moduli(poisson: float) -> tuple[float, float]:
    """Bulk and shear modulus for E* = 1, that is E = 1 - nu^2."""
    return (1.0 - poisson**2) / (3.0 * (1.0 - 2.0 * poisson)), 0.5 * (1.0 - poisson)
