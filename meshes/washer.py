"""A washer's section, with a node under the rim of what presses it: a rectangle, fine where the stress is singular, and
about a narrow hole, where displacements go as 1/r.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from meshes.triangles import checked, distance, elements_checked, larger, polygon, smaller, tagged

if TYPE_CHECKING:
    from skfem import MeshTri

GRADING = 1.6  # growth of the element size per distance from a singular point, times elements
FINEST = 1.6e-4  # element size at a singular point over the narrowest part, times elements squared
NEEDLE = 0.01  # hole's radius over the height below which it changes the stiffness by less than it squared over ten


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
    rim = checked("radius of the contact over the height", rim, inner, outer)
    inner = checked("inner radius over the height", inner, 1e-9, outer)
    outer = checked("outer radius over the height", outer, 1e-4, 1e4)
    sharp = ((inner, -1.0), (outer, -1.0)) if bonded else ()
    inside = rim < outer
    about = f"{GRADING / n!r}*{larger('x', repr(NEEDLE))}"
    return rectangle(inner, outer, 1.0, (rim,) if inside else (), ((rim, 0.0),) * inside + sharp, n, about)


def rectangle(
    left: float,
    right: float,
    height: float,
    marks: tuple[float, ...],
    sharp: tuple[tuple[float, float], ...],
    n: float,
    largest: str | None = None,
) -> MeshTri:
    """Triangles of ``left <= r <= right``, ``-height <= z <= 0``.

    ``marks``: radii on the upper side that have to be nodes; ``sharp``: points (r, z) where the stress is singular;
    ``n``: elements along the shortest length; ``largest`` size of one over (x, y), in the words of gmsh, None: any.
    Boundaries ``surface`` (z = 0), ``base``, ``inside``, ``outside``.
    """
    stops = [left, *marks, right]
    narrowest = min(height, *(far - near for near, far in pairwise(stops)))
    size = repr(min(height, right - left) / n)  # the grading takes care of what is narrower
    size = size if largest is None else smaller(largest, size)
    for r, z in sharp:
        size = smaller(f"({FINEST * narrowest / n**2!r}+{GRADING / n!r}*{distance(r, z)})", size)
    corners = [*((r, 0.0) for r in stops), (right, -height), (left, -height)]
    nodes, triangles = polygon(corners, size)
    nodes[abs(nodes) < 1e-12 * max(right, height)] = 0.0  # onto the axis and the surface exactly
    width = right - left
    return tagged(
        nodes,
        triangles,
        {
            "surface": lambda x: x[1] == 0.0,
            "base": lambda x: x[1] < -height * (1 - 1e-9),
            "inside": lambda x: x[0] < left + 1e-9 * width,
            "outside": lambda x: x[0] > right - 1e-9 * width,
        },
    )
