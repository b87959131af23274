"""The mass that the shape functions carry: couples neighbours, makes waves too fast."""

from __future__ import annotations

from fe_contact.assembly.forms import Array, Indices, Matrix, scatter
from fe_contact.dynamics.mass.base import Mass


def of(local: Array, dofs: Indices, size: int, contact: Indices) -> Matrix:
    """The element matrices as they are."""
    return scatter(local, dofs, size).tocsc()


MEMBER = Mass(of)
