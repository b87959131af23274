"""What contact knows of a body: how the points of its surface give way to the springs between it and the striker."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt
import scipy.sparse as sparse
from scipy.linalg.lapack import dgetrf, dgetrs, dposv

from fe_contact.assembly.forms import Array, Matrix

INDEPENDENT = 1e-10  # of the largest: less than this is a sum of the others, as a rigid striker's unit displacement is


@dataclass(frozen=True, eq=False)
class PressedSurface:
    """What contact knows of a body: condensed stiffness (n, n), trace (q, n), weights (q,).

    ``recurring``: whether the same sets of points touch again and again, so that their answers are worth keeping.
    ``compliance`` (q, q), displacement at the points under unit forces there, of surfaces with more nodes than points.
    ``carriers`` (q, m): shape functions of a pressure that both of two bodies can follow; of one body, those it has.
    """

    stiffness: Array
    trace: Array
    weights: Array
    recurring: bool = True
    compliance: Array | None = None
    carriers: Array | None = None

    def held(self, springs: Array) -> Array:
        """Stiffness with springs (q,) at the points, (n, n), in the order of columns that LAPACK needs."""
        return np.asarray(self.stiffness + (self._squares @ springs).reshape(self.stiffness.shape)).T

    def gaps(self, springs: Array, overlaps: Array) -> Array:
        """What is left of overlaps (q, m) where springs (q,) stand between the surfaces."""
        if self.compliance is not None:
            return _between_points(self.compliance, springs, overlaps)
        pushed = self.trace.T @ (springs[:, None] * overlaps)
        return overlaps - self.trace @ solved(self.held(springs), pushed)

    def work(self, forces: Array) -> float:
        """Of forces (q,) at the points on the displacement that they cause."""
        if self.compliance is not None:
            return float(forces @ self.compliance @ forces)
        load = self.trace.T @ forces
        return float(load @ np.linalg.solve(self.stiffness, load))

    def displaced(self, forces: Array) -> Array:
        """The points (q,) under forces (q,) at them."""
        if self.compliance is not None:
            return np.asarray(self.compliance @ forces)
        if self.recurring:
            return np.asarray(self._yields @ forces)
        factors, pivots = self._factors
        return np.asarray(self.trace @ dgetrs(factors, pivots, self.trace.T @ forces)[0])

    def in_shapes(self, pressure: Array) -> Array:
        """The nearest to a pressure (q,) that is a combination of the surface's shape functions."""
        directions = self._directions
        root = np.sqrt(self.weights)
        return np.asarray(directions @ (directions.T @ (root * pressure))) / root

    def stiffened(self, stiffness: Array) -> PressedSurface:
        """The same points on another stiffness; what is known of the points alone is shared."""
        other = replace(self, stiffness=stiffness)
        vars(other).update(_squares=self._squares, _directions=self._directions)
        return other

    @cached_property
    def _factors(self) -> tuple[Array, npt.NDArray[np.int32]]:
        """Of the stiffness alone, with their pivots."""
        return dgetrf(self.stiffness)[:2]

    @cached_property
    def _yields(self) -> Array:
        """Displacement at the points per force at the points, (q, q)."""
        return np.asarray(self.trace @ np.linalg.solve(self.stiffness, self.trace.T))

    @cached_property
    def _directions(self) -> Array:
        """The shape functions times the root of the weights, made orthonormal, (q, rank)."""
        shapes = self.trace if self.carriers is None else self.carriers
        found, sizes, _ = np.linalg.svd(np.sqrt(self.weights)[:, None] * shapes, full_matrices=False)
        return np.asarray(found[:, sizes > INDEPENDENT * sizes[0]])

    @cached_property
    def _squares(self) -> Matrix:
        """Every point's trace times itself as a column, sparse (n n, q): a point sees the nodes of its facet alone."""
        points, nodes = self.trace.shape
        rows = sparse.csr_matrix(self.trace)
        seen = [rows.indices[start:end] for start, end in zip(rows.indptr, rows.indptr[1:], strict=False)]
        pairs = [(ours[:, None] * nodes + ours).ravel() for ours in seen]
        values = [np.outer(own := self.trace[i, ours], own).ravel() for i, ours in enumerate(seen)]
        columns = np.repeat(np.arange(points), [len(pair) for pair in pairs])
        entries = (np.concatenate(values), (np.concatenate(pairs), columns))
        return sparse.csr_matrix(entries, shape=(nodes * nodes, points))


def _between_points(compliance: Array, springs: Array, overlaps: Array) -> Array:
    """By the forces of the springs: (1/k + C) forces = overlap where they stand, multiplied by the root of k."""
    acting = _those(springs)
    root = np.sqrt(springs[acting])[:, None]
    if not root.size:
        return overlaps
    system = root * compliance[acting][:, acting] * root.T
    system[np.diag_indices(root.size)] += 1.0
    scaled = solved(system.T, root * overlaps[acting])
    gaps = overlaps - compliance[:, acting] @ (root * scaled)
    gaps[acting] = scaled / root
    return gaps


def _those(springs: Array) -> slice | npt.NDArray[np.intp]:
    """Where springs stand: as a rule without a hole, and then nothing has to be copied."""
    acting = np.flatnonzero(springs)
    whole = acting.size and acting.size == acting[-1] - acting[0] + 1
    return slice(acting[0], acting[-1] + 1) if whole else acting


def solved(matrix: Array, right: Array) -> Array:
    """Of a symmetric positive definite matrix, which it overwrites with its factors. Raises FloatingPointError."""
    _, solution, failure = dposv(matrix, right, overwrite_a=True, overwrite_b=True)
    if failure:
        raise FloatingPointError("the condensed stiffness lost its positive definiteness")
    return np.asarray(solution)
