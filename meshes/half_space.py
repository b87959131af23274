"""Quarter disc under a contact circle of radius one: the mesh of an axisymmetric half-space.

The half-space has no length of its own, so its mesh is made once in units of the contact radius and
scaled to whatever radius the contact has at an instant.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshes.errors import MeshError
from meshes.triangles import (
    Outline,
    beside_flat,
    beyond,
    checked,
    distance,
    elements_checked,
    filled,
    larger,
    smaller,
    tagged,
)

if TYPE_CHECKING:
    from skfem import MeshTri

EDGE_REFINEMENT = 24.0  # element size inside the contact over element size at its edge
GROWTH = 2.0  # growth of the element size per unit distance, for one element per contact radius
ZONE = 1.1  # where contacts may end anywhere the surface is fine up to this radius
WAVE_GROWTH = 3.0  # of the element size per unit distance, for one element along the radius
OF_WAVE_GROWTH = 0.15  # of it at most, where elements along the radius are few: waves would not be seen on their way
LARGEST_GROWTH = 1.5  # steeper gradings leave gmsh too little room for well-shaped triangles


def half_space(
    elements_per_contact: float, far_radius: float, at_edge: float = EDGE_REFINEMENT, growth: float = GROWTH
) -> MeshTri:
    """Triangles of the half-space ``z <= 0`` around a contact circle ``r = 1``.

    The size function is ``1/elements_per_contact`` inside the contact, many times finer at its edge
    (where the pressure ends like a square root) and grows linearly away from both. Doubling
    ``elements_per_contact`` halves that function everywhere; below about eight it is so steep that
    triangles can follow it only in part, and their number grows by less than four.

    Parameters
    ----------
    elements_per_contact : number of elements along the contact radius, 0.25 to 64.
    far_radius : radius of the meshed quarter disc in contact radii, 2 to 1e6.
    at_edge : how many times finer elements are at the edge, 1 to 100.
    growth : of the element size per unit distance, for one element along the radius, 0.1 to 3.

    Returns
    -------
    MeshTri with coordinates (r, z) and boundaries ``surface`` (z = 0), ``axis`` (r = 0), ``far``; the
    contact edge (1, 0) is a node.

    Raises
    ------
    MeshError for numbers outside these ranges.
    """
    size = 1.0 / checked("elements_per_contact", elements_per_contact, 0.25, 64.0)
    if not 2.0 <= far_radius <= 1e6:
        raise MeshError(f"far_radius = {far_radius:g}: accepted 2 to 1e6 contact radii")
    steepest = min(checked("growth of elements", growth, 0.1, 3.0) * size, LARGEST_GROWTH)
    finest = size / checked("refinement at the edge", at_edge, 1.0, 100.0)
    near_edge = f"({finest!r}+{steepest!r}*{distance(1.0, 0.0)})"
    elsewhere = f"({size!r}+{steepest!r}*{beyond(distance(0.0, 0.0), 1.0)})"
    return _quarter(smaller(near_edge, elsewhere), 1.0, far_radius)


def half_space_for_waves(
    elements_per_radius: float,
    smallest: float,
    far_radius: float,
    finer: float = 1.0,
    growth: float = WAVE_GROWTH,
    flat: float = 0.0,
    beside: float = 1.0,
) -> MeshTri:
    """Triangles of the same outline under contacts that end anywhere up to ``r = 1``, all resolved alike.

    Elements at the surface grow in proportion to the radius. From the contact zone, 1.1, outwards they grow so slowly
    that the waves of a contact are still resolved where they are as long as their distance from it.

    Parameters
    ----------
    elements_per_radius : radius over element size at the surface, 1 to 200.
    smallest : the smallest contact radius to resolve so, 1e-3 to 1.
    far_radius : radius of the quarter disc, 2 to 1e6.
    finer : times as many elements at the surface as their growth into the body is for, 1 to 16.
    growth : of the element size per unit distance, for one element along the radius, 0.1 to 3.
    flat : radius of a flat end of the striker, 0 to 1, towards whose rim elements shrink; 0: none.
    beside : distance from that rim at which the smallest contact ends, 1e-4 to 1.

    Raises
    ------
    MeshError for numbers outside these ranges.
    """
    elements = elements_checked("the contact radius", elements_per_radius, 1.0, 200.0)
    at_surface = elements * checked("refinement of the surface", finer, 1.0, 16.0)
    most = checked("growth of elements", growth, 0.1, WAVE_GROWTH)
    low = checked("smallest contact over the largest", smallest, 1e-3, 1.0)
    far = checked("far_radius", far_radius, 2.0, 1e6)
    within = smaller(larger("x", repr(low)), repr(ZONE))
    inward = most * min(1.0 / elements, OF_WAVE_GROWTH)
    size = f"{within}/{at_surface!r}+{inward!r}*(Fabs(y)+{beyond('x', ZONE)})"
    return _quarter(beside_flat(size, at_surface, flat, beside), ZONE, far)


def _quarter(size: str, node: float, far_radius: float) -> MeshTri:
    """Triangles of a size over (x, y), in the words of gmsh; a node of the surface at ``node``."""
    corners = [(0.0, 0.0), (node, 0.0), (far_radius, 0.0), (0.0, -far_radius)]
    outline = Outline((0, -far_radius), (far_radius, 0), (0, 0, far_radius))
    points, triangles = filled(corners, [(0, 1), (1, 2), (2, 0, 3), (3, 0)], [(1, 2, 3, 4)], size, outline)
    points[np.abs(points) < 1e-12 * far_radius] = 0.0  # onto the axis and the surface exactly
    return tagged(
        points,
        triangles,
        {
            "surface": lambda x: x[1] == 0.0,
            "axis": lambda x: x[0] == 0.0,
            "far": lambda x: (x[0] > 0.0) & (x[1] < 0.0),
        },
    )
