"""The upper half of a round block, from its axis to its side."""

from __future__ import annotations

from skfem import MeshTri

from meshes._rectangle import rectangle
from meshes._sizes import checked


def prism(elements: float, half_height: float, sharp: bool) -> MeshTri:
    """Triangles of ``0 <= r <= 1``, ``-half_height <= z <= 0``.

    Parameters
    ----------
    elements : along the shorter side, 0.5 to 200.
    half_height : over the radius, 1e-4 to 1e4.
    sharp : whether the corner (1, 0) is graded to, as its stress is singular where face meets side.

    Returns
    -------
    MeshTri with coordinates (r, z) and boundaries ``surface`` (z = 0), ``base`` (the middle plane), ``inside`` (the
    axis), ``outside``.

    Raises
    ------
    MeshError for numbers outside these ranges.
    """
    n = checked("elements", elements, 0.5, 200.0)
    half_height = checked("half_height", half_height, 1e-4, 1e4)
    return rectangle(0.0, 1.0, half_height, (), ((1.0, 0.0),) if sharp else (), n)
