"""What material points remember, told on a mesh that grows with the contact.

In units of the contact radius the mesh stands still, and the material flows through it towards the middle of the
contact: da/ds = x . grad a, s the logarithm of the unit. In every element what is remembered is a polynomial; what
flows out of one flows into the next: the discontinuous Galerkin method with upwind fluxes (Cockburn and Shu 2001,
doi 10.1023/A:1012873910884). Displacements are small, so that the points' own motion is left out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array, Basis, Field, Indices, Matrix
from fe_contact.assembly.operators import element
from fe_contact.solids.base import State

if TYPE_CHECKING:
    from skfem import Element, MeshTri

TERMS = 4  # of the exponential's series, over each part of a growth
PART = 1.25  # of a growth, times the flow's largest rate: within 2.6, up to where the series of these rates stays small
NEAR = 0.1  # rounding: of that rate, which only tells the parts


@dataclass(frozen=True, eq=False)
class Growing:
    """Some elements of a mesh: ``flow`` (n, n) is the rate at which s changes the n values that make their polynomials;
    its largest ``rate``; ``fitted`` (k, points) tells the k values of an element from those at its points, ``read``
    (points, k) them back.
    """

    flow: Matrix
    rate: float
    fitted: Array
    read: Array

    @classmethod
    def of(cls, basis: Basis, elements: Indices, order: int) -> Growing:
        """Of polynomials as strains are in elements of an ``order``; nothing flows in from beyond these elements."""
        import skfem
        from scipy.sparse.linalg import eigs  # late: only what yields needs it

        lower = element(order - 1) if order > 1 else skfem.ElementTriP0()
        read = np.stack([lower.lbasis(basis.X, k)[0] for k in range(lower.doflocs.shape[0])], axis=-1)
        flow = upwind(basis.mesh.restrict(elements), skfem.ElementDG(lower))
        start = np.ones(flow.shape[0])
        rate = float(abs(eigs(flow, k=1, v0=start, tol=NEAR, return_eigenvectors=False)[0]))
        return cls(flow, rate, np.linalg.pinv(read), read)

    def carried(self, state: State, growth: float) -> State:
        """What points remember, (..., elements, points), once the mesh is ``growth`` times as large, one or more."""
        strain, amount = state
        if growth == 1.0 or not amount.any():
            return state
        told = np.matmul(np.concatenate([strain, amount[None]]), self.fitted.T)
        values = np.moveaxis(told, 0, -1).reshape(self.flow.shape[0], -1)
        parts = math.ceil(math.log(growth) * self.rate / PART)
        step = math.log(growth) / parts
        for _ in range(parts):
            term = values
            for number in range(1, TERMS + 1):
                term = step / number * (self.flow @ term)
                values = values + term
        found = np.moveaxis(values.reshape(*told.shape[1:], -1), -1, 0) @ self.read.T
        return found[:-1], np.maximum(found[-1], 0.0)


def upwind(mesh: MeshTri, broken: Element) -> Matrix:
    """The rate of functions that flow towards the origin on a ``mesh`` by their values in an element that is ``broken``
    at its sides: M^-1 (int a div(w v) - sum over sides of int a_up [v] w . n), the velocity w = -x.
    """
    from skfem import BilinearForm, BoundaryFacetBasis, CellBasis, InteriorFacetBasis, asm

    inner = CellBasis(mesh, broken)
    sides = [InteriorFacetBasis(mesh, broken, side=side) for side in (0, 1)]
    rate = BilinearForm(_within).assemble(inner) + asm(BilinearForm(_across), sides, sides)
    rate += BilinearForm(_out).assemble(BoundaryFacetBasis(mesh, broken))
    blocks = BilinearForm(_mass).assemble(inner).tobsr((inner.Nbfun, inner.Nbfun))
    inverse = sparse.bsr_matrix((np.linalg.inv(blocks.data), blocks.indices, blocks.indptr), shape=rate.shape)
    return (inverse @ rate).tocsr()


def _mass(a: Field, v: Field, w: Field) -> Array:
    return np.asarray(a * v)


def _within(a: Field, v: Field, w: Field) -> Array:
    return np.asarray(-a * (w.x[0] * v.grad[0] + w.x[1] * v.grad[1] + 2.0 * v))


def _across(a: Field, v: Field, w: Field) -> Array:
    """Sides between two elements: n points out of the first one, whose jump counts."""
    leaves = -(w.x[0] * w.n[0] + w.x[1] * w.n[1])
    upstream = np.maximum(leaves, 0.0) if w.idx[0] == 0 else np.minimum(leaves, 0.0)
    return np.asarray(-(1.0 if w.idx[1] == 0 else -1.0) * upstream * a * v)


def _out(a: Field, v: Field, w: Field) -> Array:
    """Sides of the whole mesh."""
    return np.asarray(np.minimum(w.x[0] * w.n[0] + w.x[1] * w.n[1], 0.0) * a * v)
