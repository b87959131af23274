"""A layer on a rigid base under a contact that may end anywhere: the mesh of an axisymmetric layer.

Its thickness is a length of its own, so one mesh serves every depth: elements at the surface grow in proportion
to the radius, and every contact circle is resolved alike.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from meshes.triangles import (
    beside_flat,
    beyond,
    checked,
    distance,
    elements_checked,
    larger,
    polygon,
    smaller,
    tagged,
)

if TYPE_CHECKING:
    from skfem import MeshTri

GROWTH = 4.0  # growth of the element size per unit distance from the contact, for one element along the radius
LARGEST_GROWTH = 1.0  # steeper gradings leave gmsh too little room for well-shaped triangles
LARGEST = 7.0  # element size over thickness, for one element along the radius
COARSEST = 1.0  # element size over thickness, whatever is asked
WAVE_GROWTH, LARGEST_WAVE_GROWTH = 3.0, 0.45  # the same growths where waves are resolved on their way
LARGEST_WAVE = 4.0  # the same size over thickness there
WITHIN = 2.0  # from this many thicknesses on, the surface is as fine as there: the pressure ends within one of them
ZONE = 1.1  # the surface is fine up to this radius
RIM = 1e-3  # element size at a rim over its radius, for one element along the radius


def layer(
    elements_per_radius: float,
    smallest: float,
    thickness: float,
    width: float,
    flat: float = 0.0,
    beside: float = 1.0,
) -> MeshTri:
    """Triangles of the layer ``-thickness <= z <= 0``, ``r <= 1.1 + width``, fine for contact radii up to one.

    Doubling ``elements_per_radius`` halves the element size everywhere.

    Parameters
    ----------
    elements_per_radius : radius, or two thicknesses where they are less, over element size at the surface, 1 to 200.
    smallest : the smallest contact radius to resolve so, 1e-6 to 1.
    thickness : of the layer, 1e-3 to 1e6.
    width : of what lies beyond the contact, 1e-3 to 1e8.
    flat : radius of a flat end of the striker, 0 to 1, towards whose rim elements shrink; 0: none.
    beside : distance from that rim at which the smallest contact ends, 1e-4 to 1.

    Returns
    -------
    MeshTri with coordinates (r, z) and boundaries ``surface`` (z = 0), ``axis`` (r = 0), ``base``, ``side``.

    Raises
    ------
    MeshError for numbers outside these ranges.
    """
    n, low, thick, wide = _checked(elements_per_radius, smallest, thickness, width)
    growth, largest = min(GROWTH / n, LARGEST_GROWTH), min(LARGEST / n, COARSEST)
    size = _sizes(n, low, thick, growth, largest)
    return _rectangle(beside_flat(size, n, flat, beside), ZONE, thick, wide)


def layer_for_waves(
    elements_per_radius: float, smallest: float, thickness: float, width: float, finer: float = 1.0
) -> MeshTri:
    """The same, its elements growing so slowly that waves from the contact are resolved on their way, too.

    ``finer``: times as many elements at the surface as their growth into the body is for, 1 to 16; ``smallest``,
    ``thickness`` and ``width`` are over the largest contact radius, they and errors as of :func:`layer`.
    """
    n, low, thick, wide = _checked(elements_per_radius, smallest, thickness, width)
    at_surface = n * checked("refinement of the surface", finer, 1.0, 16.0)
    growth, largest = min(WAVE_GROWTH / n, LARGEST_WAVE_GROWTH), min(LARGEST_WAVE / n, COARSEST)
    return _rectangle(_sizes(at_surface, low, thick, growth, largest), ZONE, thick, wide)


def layer_under_rim(elements_per_radius: float, thickness: float, width: float) -> MeshTri:
    """The same for a contact that ends at the node (1, 0) whatever the depth, under a pressure infinite there.

    Elements shrink towards that rim in proportion to their distance; ``thickness`` and ``width`` are over its radius.
    """
    n, _, thick, wide = _checked(elements_per_radius, 1.0, thickness, width)
    growth, largest = min(GROWTH / n, LARGEST_GROWTH), min(LARGEST / n, COARSEST)
    size = f"{RIM / n!r}+{growth!r}*{distance(1.0, 0.0)}"
    return _rectangle(smaller(size, repr(largest * thick)), 1.0, thick, wide)


def _sizes(elements: float, smallest: float, thickness: float, growth: float, largest: float) -> str:
    """In proportion to the radius at the surface, growing beyond the contact to ``largest`` thicknesses."""
    within = smaller(larger("x", repr(smallest)), repr(min(ZONE, WITHIN * thickness)))
    away = f"(Fabs(y)+{beyond('x', ZONE)})"
    return smaller(f"{within}/{elements!r}+{growth!r}*{away}", repr(largest * thickness))


def _rectangle(size: str, node: float, thickness: float, width: float) -> MeshTri:
    """Triangles of a size, a formula of gmsh; a node of the surface at ``node``."""
    side = ZONE + width
    corners = [(0.0, 0.0), (node, 0.0), (side, 0.0), (side, -thickness), (0.0, -thickness)]
    nodes, triangles = polygon(corners, size)
    nodes[abs(nodes) < 1e-12 * side] = 0.0  # onto the axis and the surface exactly
    return tagged(
        nodes,
        triangles,
        {
            "surface": lambda x: x[1] == 0.0,
            "axis": lambda x: x[0] == 0.0,
            "base": lambda x: x[1] < -thickness * (1 - 1e-9),
            "side": lambda x: x[0] > side * (1 - 1e-9),
        },
    )


def _checked(elements: float, smallest: float, thickness: float, width: float) -> tuple[float, float, float, float]:
    """The four numbers within their ranges. Raises MeshError."""
    return (
        elements_checked("the contact radius", elements, 1.0, 200.0),
        checked("smallest contact over the largest", smallest, 1e-6, 1.0),
        checked("thickness over the largest contact", thickness, 1e-3, 1e6),
        checked("width beyond the contact over it", width, 1e-3, 1e8),
    )
