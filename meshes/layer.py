"""A layer on a rigid base under a contact that may end anywhere: the mesh of an axisymmetric layer.

Its thickness is a length of its own, so one mesh serves every depth: elements at the surface grow in proportion
to the radius, and every contact circle is resolved alike.
"""

from __future__ import annotations

from skfem import MeshTri

from meshes._sizes import checked, elements_checked
from meshes.session import session
from meshes.triangles import Outline, triangulated

GROWTH = 4.0  # growth of the element size per unit distance from the contact, for one element along the radius
LARGEST_GROWTH = 1.0  # steeper gradings leave gmsh too little room for well-shaped triangles
LARGEST = 7.0  # element size over thickness, for one element along the radius
COARSEST = 1.0  # element size over thickness, whatever is asked
WAVE_GROWTH, LARGEST_WAVE_GROWTH = 2.0, 0.3  # the same growths where waves are resolved on their way
LARGEST_WAVE = 4.0  # the same size over thickness there
WITHIN = 2.0  # from this many thicknesses on, the surface is as fine as there: the pressure ends within one of them
ZONE = 1.1  # the surface is fine up to this radius
RIM = 1e-3  # element size at a rim over its radius, for one element along the radius


def layer(elements_per_radius: float, smallest: float, thickness: float, width: float) -> MeshTri:
    """Triangles of the layer ``-thickness <= z <= 0``, ``r <= 1.1 + width``, fine for contact radii up to one.

    Doubling ``elements_per_radius`` halves the element size everywhere.

    Parameters
    ----------
    elements_per_radius : radius, or two thicknesses where they are less, over element size at the surface, 1 to 200.
    smallest : the smallest contact radius to resolve so, 1e-6 to 1.
    thickness : of the layer, 1e-3 to 1e6.
    width : of what lies beyond the contact, 1e-3 to 1e8.

    Returns
    -------
    MeshTri with coordinates (r, z) and boundaries ``surface`` (z = 0), ``axis`` (r = 0), ``base``, ``side``.

    Raises
    ------
    MeshError for numbers outside these ranges.
    """
    _check(elements_per_radius, smallest, thickness, width)
    growth, largest = min(GROWTH / elements_per_radius, LARGEST_GROWTH), min(LARGEST / elements_per_radius, COARSEST)
    return _rectangle(_sizes(elements_per_radius, smallest, thickness, growth, largest), ZONE, thickness, width)


def layer_for_waves(
    elements_per_radius: float, smallest: float, thickness: float, width: float, finer: float = 1.0
) -> MeshTri:
    """The same, its elements growing so slowly that waves from the contact are resolved on their way, too.

    ``finer``: times as many elements at the surface as their growth into the body is for, 1 to 16; ``smallest``,
    ``thickness`` and ``width`` are over the largest contact radius, they and errors as of :func:`layer`.
    """
    _check(elements_per_radius, smallest, thickness, width)
    at_surface = elements_per_radius * checked("refinement of the surface", finer, 1.0, 16.0)
    growth = min(WAVE_GROWTH / elements_per_radius, LARGEST_WAVE_GROWTH)
    largest = min(LARGEST_WAVE / elements_per_radius, COARSEST)
    return _rectangle(_sizes(at_surface, smallest, thickness, growth, largest), ZONE, thickness, width)


def layer_under_rim(elements_per_radius: float, thickness: float, width: float) -> MeshTri:
    """The same for a contact that ends at the node (1, 0) whatever the depth, under a pressure infinite there.

    Elements shrink towards that rim in proportion to their distance; ``thickness`` and ``width`` are over its radius.
    """
    _check(elements_per_radius, 1.0, thickness, width)
    growth, largest = min(GROWTH / elements_per_radius, LARGEST_GROWTH), min(LARGEST / elements_per_radius, COARSEST)
    size = f"{float(RIM / elements_per_radius)!r}+{growth!r}*Sqrt((x-1)^2+y^2)"
    return _rectangle(_least(size, largest * thickness), 1.0, thickness, width)


def _sizes(elements: float, smallest: float, thickness: float, growth: float, largest: float) -> str:
    """In proportion to the radius at the surface, growing beyond the contact to ``largest`` thicknesses."""
    within = _least(_most("x", smallest), min(ZONE, WITHIN * thickness))
    away = f"(Fabs(y)+{_most(f'x-{ZONE!r}', 0.0)})"
    return _least(f"{within}/{float(elements)!r}+{growth!r}*{away}", largest * thickness)


def _rectangle(size: str, node: float, thickness: float, width: float) -> MeshTri:
    """Triangles of a size, a formula of gmsh; a node of the surface at ``node``."""
    side = ZONE + width
    with session("layer") as gmsh:
        geometry = gmsh.model.geo
        corners = [(0, 0), (node, 0), (side, 0), (side, -thickness), (0, -thickness)]
        points = [geometry.addPoint(r, z, 0) for r, z in corners]
        lines = [geometry.addLine(points[i], points[(i + 1) % len(points)]) for i in range(len(points))]
        geometry.addPlaneSurface([geometry.addCurveLoop(lines)])
        geometry.synchronize()
        nodes, triangles = triangulated(gmsh, size, Outline((0, -thickness), (side, 0)))
    nodes[abs(nodes) < 1e-12 * side] = 0.0  # onto the axis and the surface exactly
    return MeshTri(nodes, triangles).with_boundaries(
        {
            "surface": lambda x: x[1] == 0.0,
            "axis": lambda x: x[0] == 0.0,
            "base": lambda x: x[1] < -thickness * (1 - 1e-9),
            "side": lambda x: x[0] > side * (1 - 1e-9),
        }
    )


def _check(elements: float, smallest: float, thickness: float, width: float) -> None:
    elements_checked("the contact radius", elements, 1.0, 200.0)
    for name, value, low, high in (
        ("smallest contact over the largest", smallest, 1e-6, 1.0),
        ("thickness over the largest contact", thickness, 1e-3, 1e6),
        ("width beyond the contact over it", width, 1e-3, 1e8),
    ):
        checked(name, value, low, high)


def _least(formula: str, bound: float) -> str:
    """The smaller of a formula of gmsh and a number."""
    return f"(({formula})+{float(bound)!r}-Fabs(({formula})-{float(bound)!r}))/2"


def _most(formula: str, bound: float) -> str:
    """The larger of a formula of gmsh and a number."""
    return f"(({formula})+{float(bound)!r}+Fabs(({formula})-{float(bound)!r}))/2"
