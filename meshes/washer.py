"""A washer's section, with a node under the rim of what presses it."""

from __future__ import annotations

from skfem import MeshTri

from meshes._rectangle import rectangle
from meshes._sizes import checked, elements_checked


def washer(elements: float, inner: float, outer: float, rim: float, bonded: bool) -> MeshTri:
    """Triangles of ``inner <= r <= outer``, ``-1 <= z <= 0``: lengths over the washer's height.

    Parameters
    ----------
    elements : along the shortest length, 0.5 to 200.
    inner, outer : radii, above 0 and up to 1e4.
    rim : where the contact ends, over the height, above inner and up to outer; short of outer the mesh is graded to it.
    bonded : whether the lower corners are graded to.

    Returns
    -------
    MeshTri with coordinates (r, z) and boundaries ``surface`` (z = 0), ``base``, ``inside``, ``outside``.

    Raises
    ------
    MeshError for numbers outside these ranges.
    """
    n = elements_checked("the shortest length", elements, 0.5, 200.0)
    outer = checked("outer radius over the height", outer, 1e-4, 1e4)
    inner = checked("inner radius over the height", inner, 1e-9, outer)
    rim = checked("radius of the contact over the height", rim, inner, outer)
    sharp = ((inner, -1.0), (outer, -1.0)) if bonded else ()
    inside = rim < outer
    return rectangle(inner, outer, 1.0, (rim,) if inside else (), ((rim, 0.0),) * inside + sharp, n)
