"""Sections of blocks and washers: rectangles, fine at the points where the stress is singular."""

from __future__ import annotations

from itertools import pairwise

from skfem import MeshTri

from meshes._sizes import distance, smaller
from meshes.session import session
from meshes.triangles import Outline, triangulated

GRADING = 1.6  # growth of the element size per distance from a singular point, times elements
FINEST = 1.6e-4  # element size at a singular point over the narrowest part, times elements squared


def rectangle(
    left: float, right: float, height: float, marks: tuple[float, ...], sharp: tuple[tuple[float, float], ...], n: float
) -> MeshTri:
    """Triangles of ``left <= r <= right``, ``-height <= z <= 0``.

    ``marks``: radii on the upper side that have to be nodes; ``sharp``: points (r, z) where the stress is singular;
    ``n``: elements along the shortest length. Boundaries ``surface`` (z = 0), ``base``, ``inside``, ``outside``.
    """
    stops = [left, *marks, right]
    narrowest = min(height, *(far - near for near, far in pairwise(stops)))
    size = repr(min(height, right - left) / n)  # the grading takes care of what is narrower
    for r, z in sharp:
        size = smaller(f"({FINEST * narrowest / n**2!r}+{GRADING / n!r}*{distance(r, z)})", size)
    with session("rectangle") as gmsh:
        geometry = gmsh.model.geo
        corners = [*((r, 0.0) for r in stops), (right, -height), (left, -height)]
        points = [geometry.addPoint(r, z, 0) for r, z in corners]
        lines = [geometry.addLine(points[i], points[(i + 1) % len(points)]) for i in range(len(points))]
        geometry.addPlaneSurface([geometry.addCurveLoop(lines)])
        geometry.synchronize()
        nodes, triangles = triangulated(gmsh, size, Outline((left, -height), (right, 0)))
    nodes[abs(nodes) < 1e-12 * max(right, height)] = 0.0  # onto the axis and the surface exactly
    width = right - left
    return MeshTri(nodes, triangles).with_boundaries(
        {
            "surface": lambda x: x[1] == 0.0,
            "base": lambda x: x[1] < -height * (1 - 1e-9),
            "inside": lambda x: x[0] < left + 1e-9 * width,
            "outside": lambda x: x[0] > right - 1e-9 * width,
        }
    )
