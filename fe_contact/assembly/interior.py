"""The body behind its surface: from forces on the contact zone to the displacement of the whole mesh."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from fe_contact.assembly.forms import Array, Basis, Indices, Matrix

FACTORS = 20  # sizes of a matrix entry: ten of the factors, each a number, its place and as much while they grow
WORK_SPACE = 100e6  # bytes that BLAS and SuperLU take beside


@dataclass(frozen=True, eq=False)
class Interior:
    """Answers by factorising anew: the factors, ten times the matrix, are seldom wanted once the surface is condensed.

    ``matrix`` stiffness of the ``free`` degrees of freedom of all (2 N); ``push`` sparse (2 N, n): unit forces on the
    zone, out of the body; ``floating`` of a body that nothing holds.
    """

    matrix: Matrix
    free: Indices
    push: Matrix
    floating: Floating | None = None

    def factorised(self) -> Callable[[Array], Array]:
        """The same with its factors, as large as all the rest of a body and ten times more."""
        solve = factorized(self.matrix)

        def displacement(forces: Array) -> Array:
            load = -(self.push @ forces)  # pressure pushes into the body
            if self.floating is not None:
                load = self.floating.balanced(load)
            answer = np.zeros_like(load)
            answer[self.free] = solve(load[self.free])
            return answer if self.floating is None else self.floating.centred(answer)

        return displacement

    def __call__(self, forces: Array) -> Array:
        """Displacement (2 N,) of the whole mesh under nodal forces (n,) on the zone; or of (n, m) loads at once."""
        return self.factorised()(forces)


def factorized(matrix: Matrix, ordered: bool = False) -> Callable[[Array], Array]:
    """Back-substitution for a symmetric positive definite sparse matrix, of one right-hand side or several.

    ``ordered``: rows stand as :func:`elimination_order` has them. Raises MemoryError where the process may not have so
    much: SuperLU would crash, and BLAS ask for ever.
    """
    solve: Callable[[Array], Array] = _factors(matrix, "NATURAL" if ordered else "MMD_AT_PLUS_A").solve
    return solve


def elimination_order(matrix: Matrix) -> Indices:
    """Rows (n,) of such a matrix in the order that leaves factors sparse, the same for all of its pattern."""
    return np.argsort(_factors(matrix, "MMD_AT_PLUS_A").perm_c)


@dataclass(frozen=True, eq=False)
class Eliminated:
    """A symmetric sparse matrix all but whose last rows are eliminated.

    ``schur`` (m, m): what is left of the last m rows, the inverse of that part of the inverse of all; ``solve``:
    back-substitution through all rows, of one right-hand side (n,).
    """

    schur: Array
    solve: Callable[[Array], Array]

    @classmethod
    def of(cls, matrix: Matrix, last: int) -> Eliminated:
        """Of a real matrix or a complex one, whose real part is positive definite, so that no row is exchanged.

        The factors end in those of the Schur complement: none of the right-hand sides that it stands for is solved.
        Raises MemoryError as :func:`factorized` does.
        """
        factors = _factors(matrix, "NATURAL")
        lower, upper = (part.tocsc()[:, -last:][-last:].toarray() for part in (factors.L, factors.U))
        return cls(lower @ upper, factors.solve)


def _factors(matrix: Matrix, order: Literal["NATURAL", "MMD_AT_PLUS_A"]) -> Any:
    import scipy.sparse.linalg as linalg  # late: a body known from disk needs none

    if FACTORS * matrix.nnz * matrix.dtype.itemsize + WORK_SPACE > _room():
        raise MemoryError
    return linalg.splu(
        matrix.tocsc(),
        permc_spec=order,
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )


def _room() -> float:
    """Bytes of address space left to this process, where it has a limit."""
    if sys.platform != "linux":
        return math.inf
    import resource

    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    taken = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0]) * resource.getpagesize()
    return math.inf if limit == resource.RLIM_INFINITY else limit - taken


@dataclass(frozen=True, eq=False)
class Floating:
    """``mass`` (2 N,): what every axial degree of freedom carries of the body's mass, zero for the others."""

    mass: Array

    @classmethod
    def of(cls, basis: Basis, weight: Array) -> Floating:
        """Of a uniform body; ``weight`` (elements, points): volume of every quadrature point of the basis."""
        mass = np.zeros(2 * basis.N)
        for local, shape in enumerate(basis.basis):
            np.add.at(mass, 2 * basis.element_dofs[local] + 1, (np.asarray(shape[0]) * weight).sum(axis=1))
        return cls(mass)

    def balanced(self, load: Array) -> Array:
        """A load (2 N,) or loads (2 N, n) with the inertia against it, so that no resultant is left."""
        share = load[1::2].sum(axis=0) / self.mass.sum()
        return np.asarray(load - np.multiply.outer(self.mass, share))

    def centred(self, displacement: Array) -> Array:
        """Displacements (2 N,) or (2 N, n) relative to the centre of mass."""
        found = displacement.copy()
        found[1::2] -= self.mass @ displacement / self.mass.sum()
        return found
