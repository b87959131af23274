"""A scene as a body that moves: what a target with inertia hands to the march."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array, Indices, Matrix
from fe_contact.dynamics import memory
from fe_contact.dynamics.body import BodyWithMass
from fe_contact.dynamics.state import BodyState


@dataclass(frozen=True, eq=False)
class Moving:
    """A body at first touch and the striker that is its last degree of freedom, its depth.

    ``places`` (q,) of the points that may touch, m from the axis; ``endless``: nothing comes back of its waves.
    """

    body: BodyWithMass
    speed: float
    places: Array
    endless: bool

    @property
    def velocity(self) -> Array:
        """At first touch, (N,): the striker moves, the target does not."""
        velocity = np.zeros(self.body.size)
        velocity[-1] = self.speed
        return velocity

    @property
    def watch(self) -> Matrix:
        """Picks the depth, sparse (1, N)."""
        return sparse.csr_matrix(([1.0], ([0], [self.body.size - 1])), shape=(1, self.body.size))

    def in_striker(self, state: BodyState) -> tuple[float, float]:
        """Energy in the motion and in the strain of the striker, J."""
        return 0.5 * float(self.body.rigid @ state.velocity**2), 0.0


@dataclass(frozen=True, eq=False)
class Flying(Moving):
    """The same with a striker that yields: the first ``yielding`` degrees of freedom, the body's first part.

    ``start`` (N,): every whole body's share of the speed; ``approach`` (N,): weights of all displacements in the depth.
    """

    yielding: int
    start: Array
    approach: Array

    @property
    def velocity(self) -> Array:
        """A whole body moves alike everywhere."""
        return self.speed * self.start

    @property
    def watch(self) -> Matrix:
        """The approach of the centres of mass, sparse (1, N)."""
        return sparse.csr_matrix(self.approach[None])

    def in_striker(self, state: BodyState) -> tuple[float, float]:
        """All its motion, and its springs."""
        own = np.where(np.arange(self.body.size) < self.yielding, state.velocity, 0.0)
        strain = memory.stored(self.body.parts[0], state.displacement, state.branches[0])
        return 0.5 * float(own @ (self.body.mass @ own)), strain


def with_striker(matrix: Matrix, free: Indices) -> Matrix:
    """A matrix of the body's free degrees of freedom, with a row and a column of zeros for the striker."""
    inside = matrix.tocsc()[free][:, free]
    return sparse.block_diag([inside, sparse.csc_matrix((1, 1))]).tocsc()
