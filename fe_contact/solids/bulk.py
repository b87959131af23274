"""Mesh and material's response -> energy, nodal forces, consistent tangent; the pattern of the matrix is made once.

A body's core answers by its material's response, the rest of it, where strains are small, by the linear stiffness
which the response has at rest: eliminated once, it is a dense matrix between the nodes on the core's rim.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array, Basis, Indices, Matrix, values, vector_dofs, volumes
from fe_contact.assembly.interior import factorized
from fe_contact.solids.base import AXIAL, RADIAL, PointAnswer, Response, State
from lumped.materials.energies.base import bent

NOISE = 1e-11  # rounding: of an entry of a stiffness of which all has been taken away


@dataclass(frozen=True)
class Rolled:
    """A ring laid flat: where its points are, and how the slopes of what is known on the flat mesh turn with it.

    From (x, z), x the arc on the circle of ``radius``, z = radius - distance from its middle, to the plane. The middle
    is at (0, radius), the lowest point of the circle at the origin.
    """

    radius: float

    def place(self, flat: Array) -> Array:
        """Of points (2, ...)."""
        angle, distance = flat[0] / self.radius, self.radius - flat[1]
        return np.stack([distance * np.sin(angle), self.radius - distance * np.cos(angle)])

    def place_on(self, arc: Array) -> Array:
        """Of points of the circle itself."""
        return self.place(np.stack([arc, np.zeros_like(arc)]))

    def stretch(self, flat: Array) -> Array:
        """Length along the circle over that on the mesh, (...)."""
        return np.asarray(1.0 - flat[1] / self.radius)

    def slopes(self, gradient: Array, flat: Array) -> Array:
        """In the plane, (2, ..., n), of n functions' slopes on the mesh at points (2, ...)."""
        angle, along = (flat[0] / self.radius)[..., None], gradient[0] / self.stretch(flat)[..., None]
        sine, cosine = np.sin(angle), np.cos(angle)
        return np.stack([cosine * along - sine * gradient[1], sine * along + cosine * gradient[1]])


@dataclass(frozen=True, eq=False)
class Bulk:
    """Elements as material points.

    ``slopes`` (3, elements, points, n): d/dr, d/dz and 1/r (0 in plane strain) of the n scalar shape functions;
    ``weight`` (elements, points) volume of every point; ``dofs`` (elements, 2 n) of ``size`` of the whole mesh.
    """

    slopes: Array
    weight: Array
    dofs: Indices
    size: int

    @classmethod
    def of(cls, basis: Basis, plane: bool, elements: Indices, rolled: Rolled | None = None) -> Bulk:
        """Some elements of a scalar basis, axisymmetric or, of both halves, in plane strain, maybe ``rolled`` flat."""
        flat = np.asarray(basis.global_coordinates())
        gradient = np.stack([np.asarray(shape[0].grad) for shape in basis.basis], axis=-1)
        value, weight = values(basis, flat[0].shape), volumes(basis, plane)
        hoop = np.zeros_like(value) if plane else value / flat[0][:, :, None]
        if rolled is not None:
            gradient, weight = rolled.slopes(gradient, flat), weight * rolled.stretch(flat)
        slopes = np.concatenate([gradient, hoop[None]])[:, elements]
        return cls(slopes, weight[elements], vector_dofs(basis.element_dofs)[elements], 2 * int(basis.N))

    def gradient(self, displacement: Array) -> Array:
        """Of a displacement (2 N,), (5, elements, points)."""
        local = displacement[self.dofs]
        radial = np.matmul(self.slopes, local[:, 0::2, None])[..., 0]
        axial = np.matmul(self.slopes[:2], local[:, 1::2, None])[..., 0]
        return np.stack([radial[0], radial[1], axial[0], axial[1], radial[2]])

    def answered(self, displacement: Array, response: Response, state: State = ()) -> Loaded:
        """What the material answers to a displacement (2 N,) after ``state``."""
        return Loaded(self, response.respond(self.gradient(displacement), state))


@dataclass(frozen=True, eq=False)
class Loaded:
    """A bulk under a displacement."""

    bulk: Bulk
    answer: PointAnswer

    def foreseen(self, change: Array) -> Array | None:
        """The points' pulls, (2, elements, points), to first order after a ``change`` of the displacement, (2 N,)."""
        answer = self.answer
        if answer.pulls is None or answer.drifts is None:
            return None
        return np.asarray(answer.pulls + np.einsum("ai...,i...->a...", answer.drifts, self.bulk.gradient(change)))

    def under(self, pulls: Array) -> Loaded:
        """The same with a tangent by these pulls (2, elements, points) in place of its own."""
        answer = self.answer
        assert answer.pulls is not None
        return Loaded(self.bulk, replace(answer, tangent=answer.tangent + bent(pulls - answer.pulls)))

    @cached_property
    def energy(self) -> float:
        """Of all points, J (per length in plane strain); infinite where the material cannot be."""
        return float(np.vdot(self.bulk.weight, self.answer.energy))

    @cached_property
    def forces(self) -> Array:
        """Nodal forces (2 N,): derivative of the energy."""
        slopes, stress = self.bulk.slopes, self.answer.stress * self.bulk.weight
        local = np.empty((*self.bulk.dofs.shape,))
        for start, rows in ((0, RADIAL), (1, AXIAL)):
            parts = [np.matmul(stress[row][:, None], slopes[k])[:, 0] for k, row in enumerate(rows)]
            local[:, start::2] = np.sum(parts, axis=0)
        return np.asarray(np.bincount(self.bulk.dofs.ravel(), local.ravel(), self.bulk.size), dtype=float)

    def matrices(self) -> Array:
        """Consistent tangent of every element, (elements, 2 n, 2 n)."""
        tangent, slopes = self.answer.tangent * self.bulk.weight, self.bulk.slopes
        elements, points, functions = slopes.shape[1:]
        local = np.empty((elements, 2 * functions, 2 * functions))
        for (i, rows), (j, columns) in (
            ((0, RADIAL), (0, RADIAL)),
            ((0, RADIAL), (1, AXIAL)),
            ((1, AXIAL), (1, AXIAL)),
        ):
            pushed = np.empty((elements, len(rows), points, functions))
            for k, row in enumerate(rows):
                terms = (tangent[row, column][:, :, None] * slopes[m] for m, column in enumerate(columns))
                pushed[:, k] = sum(terms)
            tested = slopes[: len(rows)].transpose(1, 3, 0, 2).reshape(elements, functions, -1)
            local[:, i::2, j::2] = np.matmul(tested, pushed.reshape(elements, -1, functions))
        local[:, 1::2, 0::2] = local[:, 0::2, 1::2].transpose(0, 2, 1)
        return local


@dataclass(frozen=True, eq=False)
class Pattern:
    """Where blocks of entries stand in a sparse matrix of the free degrees of freedom.

    ``places`` of all entries of all blocks, one after the other; the last place takes those of held ones.
    """

    places: Indices
    indices: npt.NDArray[np.int32]
    pointers: npt.NDArray[np.int32]

    @classmethod
    def of(cls, blocks: Sequence[Indices], free: Indices, size: int) -> Pattern:
        """Of square blocks, each (m, k) degrees of freedom of ``size``; ``free`` of all that are not held."""
        number = np.full(size, -1)
        number[free] = np.arange(free.size)
        keys = [_keys(number[block], free.size) for block in blocks]
        found, places = np.unique(np.concatenate(keys), return_inverse=True)
        entries = found[found < free.size**2]
        pointers = np.searchsorted(entries, free.size * np.arange(free.size + 1))
        return cls(places, (entries % free.size).astype(np.int32), pointers.astype(np.int32))

    @property
    def definite(self) -> Matrix:
        """A positive definite matrix of this pattern, (free, free)."""
        free = self.pointers.size - 1
        ones = sparse.csc_matrix((np.ones(self.indices.size), self.indices, self.pointers), shape=(free, free))
        return sparse.diags(1.0 + np.diff(self.pointers)) + ones

    def matrix(self, blocks: Sequence[Array]) -> Matrix:
        """The sum of blocks (m, k, k) as a sparse matrix, (free, free)."""
        values = np.concatenate([block.ravel() for block in blocks])
        sums = np.bincount(self.places, values, minlength=self.indices.size)[: self.indices.size]
        free = self.pointers.size - 1
        return sparse.csc_matrix((sums, self.indices, self.pointers), shape=(free, free))


def _keys(numbers: Indices, free: int) -> Indices:
    """Place of every entry of square blocks in the full matrix by columns, one beyond it where one is held."""
    rows, columns = numbers[:, :, None], numbers[:, None, :]
    return np.asarray(np.where((rows < 0) | (columns < 0), free**2, columns * free + rows)).ravel()


@dataclass(frozen=True, eq=False)
class CoredBody:
    """A ``core`` that answers by a ``response``; ``rest`` (n, n) stiffness of all else between ``rim`` nodes' (n,)
    degrees of freedom, and ``pull`` (n,) the forces that it bears undeformed, where it remembers; ``free`` degrees of
    freedom of the core that are not held; ``datum`` (2 N,): by all degrees of freedom of the core how far the place
    comes up from which depth is measured, zero where that is at rest.
    """

    core: Bulk
    response: Response
    rest: Array
    pull: Array
    rim: Indices
    free: Indices
    datum: Array

    @classmethod
    def whole(cls, core: Bulk, response: Response, fixed: Indices) -> CoredBody:
        """All of which answers by the response."""
        none, free = np.zeros(0, dtype=int), np.setdiff1d(np.unique(core.dofs), fixed)
        return cls(core, response, np.zeros((0, 0)), np.zeros(0), none, free, np.zeros(core.size))

    @classmethod
    def of(
        cls,
        core: Bulk,
        response: Response,
        stiffness: Matrix,
        fixed: Indices,
        state: State = (),
        datum: Matrix | None = None,
    ) -> CoredBody:
        """Of the linear ``stiffness`` of the whole body, (2 N, 2 N), of which the core at rest is a part.

        ``datum``, sparse (1, 2 N): how far the place from which depth is measured comes up; None where it is at rest.
        """
        at_rest = core.answered(np.zeros(core.size), response, state)
        everything = np.arange(core.size)
        inner = Pattern.of([core.dofs], everything, core.size).matrix([at_rest.matrices()])
        whole = stiffness.tocsc()
        beside = _denoised((whole - inner).tocoo(), whole.diagonal())
        within = np.unique(core.dofs)
        loaded = np.flatnonzero(np.diff(beside.indptr))
        rim = np.setdiff1d(np.intersect1d(within, loaded), fixed)
        outer = np.setdiff1d(np.setdiff1d(loaded, within), fixed)
        rest = beside[rim][:, rim].toarray()
        comes_up = np.zeros(core.size) if datum is None else datum.toarray()[0]
        if outer.size:
            coupling = beside[outer][:, rim]
            follows = factorized(beside[outer][:, outer].tocsc())(coupling.toarray())
            rest -= coupling.T @ follows
            comes_up[rim] -= comes_up[outer] @ follows
            comes_up[outer] = 0.0
        free = np.setdiff1d(within, fixed)
        return cls(core, response, 0.5 * (rest + rest.T), np.zeros(rim.size), rim, free, comes_up)

    def forces(self, loaded: Loaded, displacement: Array) -> Array:
        """Nodal forces (2 N,) of all of it, where a displacement (2 N,) has ``loaded`` its core."""
        found = loaded.forces.copy()
        found[self.rim] += self.rest @ displacement[self.rim] + self.pull
        return found


def _denoised(difference: Matrix, diagonal: Array) -> Matrix:
    """Without what rounding leaves of entries that have been taken away."""
    size = np.sqrt(diagonal[difference.row] * diagonal[difference.col])
    kept = np.abs(difference.data) > NOISE * size
    entries = (difference.data[kept], (difference.row[kept], difference.col[kept]))
    return sparse.csc_matrix(entries, shape=difference.shape)
