"""A scene as a body that moves: what a target with inertia hands to the march."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sparse

from fe_contact.dynamics.body import Body
from fe_contact.dynamics.mass.consistent import Nodes
from fe_contact.forms import Array


@dataclass(frozen=True, eq=False)
class Moving:
    """A body at first touch and the striker that is its last degree of freedom, its depth.

    ``places`` (q,) of the points that may touch, m from the axis; ``endless``: nothing comes back of its waves.
    """

    body: Body
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
    def watch(self) -> Any:
        """Picks the depth, sparse (1, N)."""
        return sparse.csr_matrix(([1.0], ([0], [self.body.size - 1])), shape=(1, self.body.size))


def with_striker(matrix: Any, free: Nodes) -> Any:
    """A matrix of the body's free degrees of freedom, with a row and a column of zeros for the striker."""
    inside = matrix.tocsc()[free][:, free]
    return sparse.block_diag([inside, sparse.csc_matrix((1, 1))]).tocsc()
