"""The mass that the shape functions carry: couples neighbours, makes waves too fast."""

from __future__ import annotations

from typing import Any

import numpy.typing as npt

from fe_contact.assembly.forms import Array, scatter

Nodes = npt.NDArray[Any]


def of(local: Array, dofs: Nodes, size: int, contact: Nodes) -> Any:
    """The element matrices as they are."""
    return scatter(local, dofs, size).tocsc()
