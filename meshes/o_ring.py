"""The upper half of an O-ring's section, touched at its top."""

from __future__ import annotations

from typing import TYPE_CHECKING

from meshes.sphere import rounded, sizes
from meshes.triangles import Outline, checked, elements_checked, filled, tagged

if TYPE_CHECKING:
    from skfem import MeshTri2


def o_ring(elements: float, smallest: float, contact: float, mean_radius: float, order: int) -> MeshTri2:
    """Curved triangles of the half disc ``z >= -1`` of radius 1 about (mean_radius, -1).

    Parameters
    ----------
    elements : along a contact's half-width, 1 to 200.
    smallest : the smallest contact to resolve so, over the largest, 1e-6 to 1.
    contact : angle of the largest contact from its middle, 1e-9 to 1.4 rad.
    mean_radius : of the ring over the section's, 1 to 1e9.
    order : of the elements on this mesh, 1 to 4: the lower, the smaller those in the bulk.

    Returns
    -------
    MeshTri2 with coordinates (r, z) and boundaries ``surface`` (the circle), ``base`` (the middle plane).

    Raises
    ------
    MeshError for numbers outside these ranges.
    """
    n = elements_checked("a contact", elements, 1.0, 200.0)
    mean_radius = checked("mean radius over the section's", mean_radius, 1.0, 1e9)
    low = checked("smallest contact over the largest", smallest, 1e-6, 1.0)
    size = sizes(n, low, checked("angle of the largest contact", contact, 1e-9, 1.4), order)
    left, top, right, centre = range(4)
    edges = [(top, centre), (top, centre, left), (left, centre), (centre, right), (right, centre, top)]
    halves = [(2, 3, -1), (4, 5, 1)]  # without a line between them, and nodes on it, gmsh is twenty times slower
    corners = [(-1, -1), (0, 0), (1, -1), (0, -1)]
    nodes, triangles = filled(corners, edges, halves, size, Outline((-1, -1), (1, 0), (0, -1, 1)))
    nodes[1, abs(nodes[1] + 1.0) < 1e-14] = -1.0  # onto the middle plane
    section = tagged(nodes, triangles, {"surface": lambda x: x[1] > -1.0, "base": lambda x: x[1] == -1.0})
    return rounded(section).translated((mean_radius, 0.0))
