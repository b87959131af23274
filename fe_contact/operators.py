"""Mesh and Poisson's ratio -> what the contact surface knows of the body: one condensed operator.

Assembled and factorised once; a unit force on every surface degree of freedom gives the compliance
``C = B K^-1 B^T``. All quantities are for contact radius 1 and contact modulus E* = 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse.linalg as linalg
from skfem import (
    Basis,
    ElementTriP1,
    ElementTriP2,
    ElementTriP3,
    ElementTriP4,
    FacetBasis,
    MeshTri,
)

from fe_contact.far_field import static
from fe_contact.forms import Array, isotropic, stiffness

ELEMENTS = {1: ElementTriP1, 2: ElementTriP2, 3: ElementTriP3, 4: ElementTriP4}
CONTACT_ZONE = 1.1  # contact is sought up to this multiple of the predicted contact radius
FACET_POINTS = 4  # quadrature points a facet beyond the element order: the contact edge is a kink


@dataclass(frozen=True)
class SurfaceOperator:
    """A body seen through its surface, in units of contact radius and contact modulus.

    ``nodes`` (n_s,) radii of all surface nodes, sorted, ``order`` of them a facet plus one;
    ``stiffness`` (n, n) condensed normal stiffness of the n first nodes, those in the contact zone;
    ``response`` (n_s, n) normal displacement of all surface nodes under unit nodal forces there;
    ``points``, ``weights`` (q,) quadrature of the contact zone, weights including 2 pi r;
    ``trace`` (q, n) displacement at the points from that of the nodes;
    ``solve`` maps nodal forces (n,) on the zone to the displacement of the whole mesh (2 N,);
    ``basis`` the scalar scikit-fem basis, ``poisson`` its Poisson's ratio.
    """

    nodes: Array
    order: int
    stiffness: Array
    response: Array
    points: Array
    weights: Array
    trace: Array
    solve: Callable[[Array], Array]
    basis: Any
    poisson: float

    @property
    def degrees_of_freedom(self) -> int:
        """Unknowns of the finite-element system behind the surface."""
        return 2 * int(self.basis.N)


def surface_operator(mesh: MeshTri, order: int, poisson: float) -> SurfaceOperator:
    """Assemble, factorise once and condense the half-space on ``mesh`` to its contact zone.

    Parameters
    ----------
    mesh : boundaries ``surface``, ``axis``, ``far``; contact radius 1.
    order : element order, 1 to 4.
    poisson : Poisson's ratio.
    """
    basis = Basis(mesh, ELEMENTS[order](), intorder=2 * order)
    return condensed(basis, system_matrix(basis, poisson), 2 * basis.get_dofs("axis").flatten(), poisson)


def condensed(basis: Any, matrix: Any, fixed: npt.NDArray[np.integer[Any]], poisson: float) -> SurfaceOperator:
    """Factorise the stiffness of a body once and condense it to its contact zone.

    Parameters
    ----------
    basis : scalar scikit-fem basis with N functions, its mesh with the boundary ``surface``; contact radius 1.
    matrix : stiffness for E* = 1, sparse (2 N, 2 N).
    fixed : degrees of freedom held at zero.
    poisson : Poisson's ratio.
    """
    order = basis.elem.maxdeg
    surface = _surface_dofs(basis)
    nodes = basis.doflocs[0, surface]
    corners = nodes[::order]
    zone = corners[: np.searchsorted(corners, CONTACT_ZONE) + 1]  # whole facets only
    in_zone = surface[: (len(zone) - 1) * order + 1]
    free = np.setdiff1d(np.arange(matrix.shape[0]), fixed)
    factor = linalg.splu(
        matrix[free][:, free],
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )

    def displacement(forces: Array) -> Array:
        load = np.zeros((matrix.shape[0], *forces.shape[1:]))
        load[2 * in_zone + 1] = -forces  # pressure pushes along -z
        answer = np.zeros_like(load)
        answer[free] = factor.solve(load[free])
        return answer

    response = -displacement(np.eye(len(in_zone)))[2 * surface + 1]
    compliance = response[: len(in_zone)]
    condensed = np.linalg.inv((compliance + compliance.T) / 2)
    points, weights, trace = _contact_quadrature(zone, order)
    return SurfaceOperator(
        nodes=nodes,
        order=order,
        stiffness=(condensed + condensed.T) / 2,
        response=response,
        points=points,
        weights=weights,
        trace=trace,
        solve=displacement,
        basis=basis,
        poisson=poisson,
    )


def system_matrix(basis: Any, poisson: float) -> Any:
    """Stiffness of body and far field for E* = 1, sparse (2 N, 2 N); the axis is not yet fixed."""
    order = basis.elem.maxdeg
    far = FacetBasis(basis.mesh, basis.elem, facets=basis.mesh.boundaries["far"], intorder=2 * order + 4)
    body = stiffness(basis, isotropic(1 - poisson**2, poisson))
    return (body + static.robin(far, poisson)).tocsc()


def _surface_dofs(basis: Any) -> Any:
    """Scalar degrees of freedom on the surface, from the axis outwards."""
    dofs = basis.get_dofs("surface").flatten()
    return dofs[np.argsort(basis.doflocs[0, dofs])]


def _contact_quadrature(corners: Array, order: int) -> tuple[Array, Array, Array]:
    """Gauss points, weights (with 2 pi r) and Lagrange trace on the facets between ``corners``."""
    gauss, weight = np.polynomial.legendre.leggauss(order + FACET_POINTS)
    left, length = corners[:-1, None], np.diff(corners)[:, None]
    points = (left + length * (gauss + 1) / 2).ravel()
    weights = 2 * np.pi * points * (length * weight / 2).ravel()
    local = lagrange((gauss + 1) / 2, order)
    trace = np.zeros((len(points), (len(corners) - 1) * order + 1))
    for facet in range(len(corners) - 1):
        rows = slice(facet * len(gauss), (facet + 1) * len(gauss))
        trace[rows, facet * order : (facet + 1) * order + 1] = local
    return points, weights, trace


def lagrange(x: Array, order: int) -> Array:
    """Equispaced Lagrange polynomials on [0, 1] at ``x``, shape (len(x), order + 1)."""
    return np.vander(x, order + 1, increasing=True) @ monomials(order)


@cache
def monomials(order: int) -> Array:
    """Coefficients (power, function) of the equispaced Lagrange polynomials on [0, 1]."""
    nodes: Array = np.arange(order + 1) / order
    return np.asarray(np.linalg.inv(np.vander(nodes, increasing=True)), dtype=np.float64)
