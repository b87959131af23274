"""A section in plane strain drawn out along its length, to ends that are free: three-dimensional, linear, at rest.

The section is a mesh of the plane with its supports; along the length y stand line elements, so that shape functions
are products. A section's displacements (u, v along its axes, w along the length) strain by their values
there and by their slopes along the length, and with shape functions q(y)

    strain = B0 q + B1 dq/dy ,    K = A x M + B x C + (B x C)^T + D x S ,

where A, B, D are integrals of B0^T E B0, B0^T E B1, B1^T E B1 over the section, M, C, S those of q q, q q', q' q' over
the length, and x is Kronecker's product. What neither moves along the length nor differs there feels A alone: plane
strain on the same mesh. The middle of the length is a plane of symmetry. Where a section's base holds both of its
displacements, it holds the third one too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array, Indices, Matrix, plane_strain, polar_strain, scatter, values
from fe_contact.assembly.interior import factorized
from fe_contact.assembly.operators import SOLVED_AT_ONCE, SolidMesh, SurfaceOperator, moduli
from fe_contact.assembly.surface import contact_quadrature, lagrange, monomials
from fe_contact.contact.problem import PressedSurface
from fe_contact.errors import SolidTooLarge

MOST_ENTRIES = 4_000_000  # work: of A x M; the stiffness, its factors and what is solved take half a gigabyte then
BOTH = 2.0  # halves of a section


@dataclass(frozen=True, eq=False)
class Pressable:
    """What contact knows of a body or of its section: the ``surface``, for E* = 1 in units of the mesh.

    ``places`` (q,) of its points along the section; ``pull`` (q,): force along the motion, per length, of a pressure.
    """

    surface: PressedSurface
    places: Array
    pull: Array

    @classmethod
    def plane(cls, operator: SurfaceOperator) -> Pressable:
        """A section in plane strain."""
        surface = PressedSurface(operator.stiffness, operator.trace, operator.weights, recurring=False)
        return cls(surface, operator.points, operator.pull)


def extruded(mesh: SolidMesh, poisson: float, corners: Array, order: int, held: bool = False) -> Pressable:
    """The section drawn out along ``corners`` (m,) of line elements, ascending from the middle, 0, to the end.

    ``order`` of these; ``held``: whether the end may not move along the length, so that all of it is in plane strain.
    Raises SolidTooLarge.
    """
    basis, surface = mesh.body.basis, mesh.body.surface
    length = float(corners[-1])
    along = _length(corners, order)
    matrix = _stiffness(mesh, poisson, along)
    free = np.setdiff1d(np.arange(matrix.shape[0]), _fixed(mesh, along[0].shape[0], held))
    places, weights, trace = surface.quadrature(int(basis.elem.maxdeg))
    pushed = surface.dofs[: trace.shape[1], None] + basis.N * np.arange(along[0].shape[0])
    compliance = _compliance(matrix[free][:, free], np.searchsorted(free, 3 * pushed.ravel() + 1))
    points, widths, trace_along = contact_quadrature(corners, order)
    stiffness = np.linalg.inv((compliance + compliance.T) / 2)
    areas, both = np.asarray(np.kron(weights, widths)), np.asarray(np.kron(trace, trace_along))
    return Pressable(
        PressedSurface((stiffness + stiffness.T) / 2, both, areas, recurring=False),
        np.repeat(places, points.size),
        areas * surface.motion(np.repeat(places, points.size)) / length,
    )


def _length(corners: Array, order: int) -> tuple[Matrix, Matrix, Matrix]:
    """M, C, S of line elements, sparse."""
    gauss, weight = np.polynomial.legendre.leggauss(order + 1)
    share, powers = (gauss + 1) / 2, np.arange(1, order + 1)[:, None]
    value = lagrange(share, order)
    slope = np.vander(share, order, increasing=True) @ (powers * monomials(order)[1:])
    dofs = order * np.arange(corners.size - 1)[:, None] + np.arange(order + 1)
    sizes, size = np.diff(corners)[:, None, None], order * (corners.size - 1) + 1
    parts = ((value, value, sizes), (value, slope, sizes**0), (slope, slope, 1.0 / sizes))
    mass, mixed, stiff = (
        scatter(scale * (first.T @ (weight[:, None] / 2 * second)), dofs, size).tocsr()
        for first, second, scale in parts
    )
    return mass, mixed, stiff


def _stiffness(mesh: SolidMesh, poisson: float, along: tuple[Matrix, Matrix, Matrix]) -> Matrix:
    """Of both halves of a section, half of the length, for E* = 1: degree 3 (k + N j) + c. Raises SolidTooLarge."""
    basis, (bulk, shear) = mesh.body.basis, moduli(poisson)
    law = shear * np.diag([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])
    law[:3, :3] += bulk - 2.0 * shear / 3.0
    value, slope, weight = _strains(mesh)
    elements, points, _, functions = value.shape
    shape = (elements, 6 * points, functions)
    stress = [np.matmul(law, one) * weight[:, :, None, None] for one in (value, slope)]
    nodes = np.asarray(basis.element_dofs).T
    dofs = (3 * nodes[:, :, None] + np.arange(3)).reshape(elements, functions)
    plane, mixed, stiff = (
        scatter(np.matmul(one.reshape(shape).transpose(0, 2, 1), two.reshape(shape)), dofs, 3 * basis.N).tocsr()
        for one, two in ((value, stress[0]), (value, stress[1]), (slope, stress[1]))
    )
    for part in (plane, mixed, stiff):
        part.eliminate_zeros()  # w along the length meets u and v across it in one of them alone
    entries = plane.nnz * along[0].nnz
    if entries > MOST_ENTRIES:
        raise SolidTooLarge(entries, MOST_ENTRIES)
    twisted = sparse.kron(along[1], mixed)
    return (sparse.kron(along[0], plane) + twisted + twisted.T + sparse.kron(along[2], stiff)).tocsr()


def _strains(mesh: SolidMesh) -> tuple[Array, Array, Array]:
    """B0, B1 (elements, points, 6, 3 functions), rows xx, zz, yy, shears xz, xy, zy; areas (elements, points)."""
    basis, inner = mesh.body.basis, mesh.inner_radius
    plane = plane_strain(basis) if inner is None else polar_strain(basis, inner)
    elements, points, _, pairs = plane.shape
    shapes = values(basis, (elements, points))
    value, slope = np.zeros((2, elements, points, 6, 3 * pairs // 2))
    for component in range(2):
        value[:, :, [0, 1, 3], component::3] = plane[:, :, [0, 1, 3], component::2]
        value[:, :, 4 + component, 2::3] = plane[:, :, component, component::2]  # w by x, w by z
        slope[:, :, 4 + component, component::3] = shapes
    slope[:, :, 2, 2::3] = shapes
    wider = 1.0 if inner is None else 1.0 - np.asarray(basis.global_coordinates())[1] / inner
    return value, slope, BOTH * wider * np.asarray(basis.dx)


def _fixed(mesh: SolidMesh, sections: int, held: bool) -> Indices:
    """Degrees of freedom at zero: the supports of every section, and what may not move along the length."""
    basis, fixed = mesh.body.basis, mesh.body.fixed
    base = basis.get_dofs("base").flatten()
    bonded = bool(np.isin(2 * base, fixed).all() and np.isin(2 * base + 1, fixed).all())
    supported = np.concatenate([3 * (fixed // 2) + fixed % 2, 3 * base + 2 if bonded else base[:0]])
    everywhere = supported + 3 * basis.N * np.arange(sections)[:, None]
    lengthwise = 3 * np.arange(basis.N) + 2
    ends = [lengthwise, lengthwise + 3 * basis.N * (sections - 1)] if held else [lengthwise]
    return np.concatenate([everywhere.ravel(), *ends])


def _compliance(matrix: Matrix, pushed: Indices) -> Array:
    """Displacement of the pushed degrees of freedom under unit forces there, (n, n)."""
    solve, size = factorized(matrix), pushed.size
    answers = []
    for some in np.array_split(np.arange(size), -(-size // SOLVED_AT_ONCE)):
        load = np.zeros((matrix.shape[0], some.size))
        load[pushed[some], np.arange(some.size)] = 1.0
        answers.append(solve(load)[pushed])
    return np.hstack(answers)
