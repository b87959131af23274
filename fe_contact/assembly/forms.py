"""Weak forms as arrays: axisymmetric strain, isotropic stress, stiffness.

The batched ``B^T D B`` is the form ``2 pi int sigma(u):eps(v) r dr dz`` evaluated on all elements at once
(three times faster than a loop over pairs of shape functions, and identical to rounding).
Vector degree of freedom ``2k + c`` belongs to scalar degree ``k`` and component ``c`` (0 radial, 1 axial).
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import scipy.sparse as sparse

from lumped.errors import BadInput, Fault
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Scene

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.integer[Any]]  # degrees of freedom, nodes, rows: of whatever width they come
Basis: TypeAlias = Any  # of scikit-fem, which ships no types
Field: TypeAlias = Any  # in a form of scikit-fem: a function with its derivatives, or what is known of a place
Matrix: TypeAlias = Any  # sparse, in any of scipy's formats, which share no class that has all they have
LARGEST_NU = 0.4999  # elements of every order are tried so far by `fe-contact stability`


def check_compressible(scene: Scene | Indenter) -> None:
    """Raise BadInput for a nu with which volume is too stiff beside shape for elements that know displacements."""
    faults = [
        Fault(scene.source, f"{part}.material.nu", f"{material.nu:.10g}: finite elements take it above -1 and up to "
              f"{LARGEST_NU}; cure: such a nu, or --method ting where the body has a load curve, which takes 0.5")
        for part, material in scene.geometry.yielding
        if material.nu > LARGEST_NU
    ]  # fmt: skip
    if faults:
        raise BadInput(faults)


def isotropic(young: float, poisson: float) -> Array:
    """Stress over strain for (rr, zz, hoop, engineering shear rz); shape (4, 4), Pa."""
    shear = young / (2 * (1 + poisson))
    lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    law = np.full((4, 4), lame)
    law[3, :] = law[:, 3] = 0.0
    return law + shear * np.diag([2.0, 2.0, 2.0, 1.0])


def elastic(bulk: float, shear: float) -> Array:
    """As :func:`isotropic`, by bulk and shear modulus, Pa, of which one may be zero: K tr(eps) + 2 G dev(eps)."""
    law = shear * np.diag([2.0, 2.0, 2.0, 1.0])
    law[:3, :3] += bulk - 2.0 * shear / 3.0
    return law


def plane_strain(basis: Basis) -> Array:
    """Strain of every vector shape function in plane strain, shape (elements, points, 4, 2 x scalar functions).

    Rows: ``du_r/dr``, ``du_z/dz``, out of the plane zero, ``du_r/dz + du_z/dr``.
    """
    gradient = np.stack([shape[0].grad for shape in basis.basis], axis=-1)
    strain = np.zeros((*gradient.shape[1:3], 4, 2 * gradient.shape[-1]))
    strain[:, :, 0, 0::2] = gradient[0]
    strain[:, :, 1, 1::2] = gradient[1]
    strain[:, :, 3, 0::2] = gradient[1]
    strain[:, :, 3, 1::2] = gradient[0]
    return strain


def axisymmetric_strain(basis: Basis) -> Array:
    """As :func:`plane_strain`, with the hoop's ``u_r/r``: Gauss points never lie on the axis, so that it is finite."""
    radius = np.asarray(basis.global_coordinates())[0]
    strain = plane_strain(basis)
    strain[:, :, 2, 0::2] = values(basis, radius.shape) / radius[:, :, None]
    return strain


def polar_strain(basis: Basis, inner_radius: float) -> Array:
    """Plane strain of a ring laid flat: x is arc length on its inner surface, z = inner_radius - r out of the body.

    The rectangle's straight elements then have the ring's exact arcs. Rows as in :func:`plane_strain`.
    """
    place = np.asarray(basis.global_coordinates())
    radius = inner_radius - place[1]
    turned, strain = values(basis, radius.shape) / radius[:, :, None], plane_strain(basis)
    for row, column in ((0, 0), (3, 1)):
        strain[:, :, row, column::2] *= (inner_radius / radius)[:, :, None]
    strain[:, :, 0, 1::2] = -turned
    strain[:, :, 3, 0::2] += turned
    return strain


def polar_stiffness(basis: Basis, law: Array, inner_radius: float) -> sparse.coo_matrix:
    """Stiffness matrix per unit length of both halves of a ring laid flat, see :func:`polar_strain`."""
    radius = inner_radius - np.asarray(basis.global_coordinates())[1]
    weight = volumes(basis, plane=True) * radius / inner_radius
    return _assembled(basis, law, polar_strain(basis, inner_radius), weight)


def volumes(basis: Basis, plane: bool = False) -> Array:
    """Of the quadrature points, (elements, points): of a body of revolution, m^3, or of both halves of one in plane
    strain, per unit length, m^2.
    """
    areas = np.asarray(basis.dx)
    return 2.0 * areas if plane else 2.0 * np.pi * np.asarray(basis.global_coordinates())[0] * areas


def stiffness(basis: Basis, law: Array, plane: bool = False) -> sparse.coo_matrix:
    """Stiffness matrix of an axisymmetric body, shape (2 N, 2 N), N/m; or of both halves of one in plane strain, N/m^2.

    Parameters
    ----------
    basis : scalar scikit-fem basis with N degrees of freedom.
    law : stress over strain, shape (4, 4), see :func:`isotropic`.
    """
    strain = plane_strain(basis) if plane else axisymmetric_strain(basis)
    return _assembled(basis, law, strain, volumes(basis, plane))


def mass(basis: Basis, plane: bool = False) -> Array:
    """Consistent mass of every element of an axisymmetric body of density one, (elements, 2 n, 2 n), m^3; or of both
    halves of one in plane strain, m^2.
    """
    weight = volumes(basis, plane)
    value = values(basis, weight.shape)
    scalar = np.einsum("eqi,eqj,eq->eij", value, value, weight, optimize=True)
    elements, functions, _ = scalar.shape
    local = np.zeros((elements, 2 * functions, 2 * functions))
    local[:, 0::2, 0::2] = local[:, 1::2, 1::2] = scalar
    return local


def _assembled(basis: Basis, law: Array, strain: Array, weight: Array) -> sparse.coo_matrix:
    """``int sigma(u):eps(v)`` with strains (elements, points, 4, functions) and weights (elements, points)."""
    elements, points, _, functions = strain.shape
    stress = np.matmul(law, strain)
    stress *= weight[:, :, None, None]  # in place: the largest array of all
    flat = (elements, 4 * points, functions)
    local = np.matmul(strain.reshape(flat).transpose(0, 2, 1), stress.reshape(flat))
    return scatter(local, vector_dofs(basis.element_dofs), 2 * basis.N)


def values(basis: Basis, shape: tuple[int, ...]) -> Array:
    """Of the scalar shape functions at the points of a ``shape``, (elements, points, functions)."""
    return np.stack([np.broadcast_to(np.asarray(one[0]), shape) for one in basis.basis], axis=-1)


def vector_dofs(scalar_dofs: Indices) -> Indices:
    """Vector degrees of freedom of each element, shape (elements, 2 x scalar functions)."""
    functions, elements = scalar_dofs.shape
    dofs = np.empty((elements, 2 * functions), dtype=scalar_dofs.dtype)
    dofs[:, 0::2] = 2 * scalar_dofs.T
    dofs[:, 1::2] = 2 * scalar_dofs.T + 1
    return dofs


def scatter(local: Array, dofs: Indices, size: int) -> sparse.coo_matrix:
    """Sum element matrices (elements, n, n) with numbering (elements, n) into a sparse (size, size)."""
    rows = np.broadcast_to(dofs[:, :, None], local.shape)
    columns = np.broadcast_to(dofs[:, None, :], local.shape)
    return sparse.coo_matrix((local.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size))
