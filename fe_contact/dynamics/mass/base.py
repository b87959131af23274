"""What a way to put an element's mass on its nodes is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from fe_contact.assembly.forms import Array, Indices, Matrix
from lumped.schema.members import Folder


class MassMatrix(Protocol):
    """From elements to the body."""

    def __call__(self, local: Array, dofs: Indices, size: int, contact: Indices) -> Matrix:
        """Sparse (size, size), kg, its total the body's mass: of ``local`` (e, k, k), consistent mass of every element,
        kg, ``dofs`` (e, k), their nodes among ``size``, and ``contact`` (c,), the nodes that may touch.
        """


@dataclass(frozen=True)
class Mass:
    """``of``: the matrix of a body."""

    of: MassMatrix


MASSES = Folder[Mass]("fe_contact.dynamics.mass", "numerics", "mass")
