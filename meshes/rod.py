"""A rod: a line of equal elements from its struck end to the other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshes.errors import MeshError

if TYPE_CHECKING:
    from skfem import MeshLine

MOST = 100_000  # work: elements along a rod


def rod(elements: int) -> MeshLine:
    """Line elements of a rod of length one, struck at x = 0.

    Parameters
    ----------
    elements : how many, 1 to 100000.

    Returns
    -------
    MeshLine with boundaries ``struck`` (x = 0) and ``end`` (x = 1).

    Raises
    ------
    MeshError for a number outside this range.
    """
    if not 1 <= elements <= MOST:
        raise MeshError(f"elements along the rod = {elements:g}: accepted 1 to {MOST}")
    from skfem import MeshLine

    mesh = MeshLine(np.linspace(0.0, 1.0, elements + 1))
    return mesh.with_boundaries({"struck": lambda x: x[0] == 0.0, "end": lambda x: x[0] == 1.0})
