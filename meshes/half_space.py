"""Quarter disc under a contact circle of radius one: the mesh of an axisymmetric half-space.

The half-space has no length of its own, so its mesh is made once in units of the contact radius and
scaled to whatever radius the contact has at an instant.
"""

from __future__ import annotations

import numpy as np
from skfem import MeshTri

from meshes.errors import MeshError
from meshes.session import session
from meshes.triangles import triangulated

EDGE_REFINEMENT = 24.0  # element size inside the contact over element size at its edge
GROWTH = 2.0  # growth of the element size per unit distance, for one element per contact radius
LARGEST_GROWTH = 1.5  # steeper gradings leave gmsh too little room for well-shaped triangles


def half_space(elements_per_contact: float, far_radius: float) -> MeshTri:
    """Triangles of the half-space ``z <= 0`` around a contact circle ``r = 1``.

    The size function is ``1/elements_per_contact`` inside the contact, 24 times finer at its edge
    (where the pressure ends like a square root) and grows linearly away from both. Doubling
    ``elements_per_contact`` halves that function everywhere; below about eight it is so steep that
    triangles can follow it only in part, and their number grows by less than four.

    Parameters
    ----------
    elements_per_contact : number of elements along the contact radius, 0.25 to 64.
    far_radius : radius of the meshed quarter disc in contact radii, 2 to 1e6.

    Returns
    -------
    MeshTri with coordinates (r, z) and boundaries ``surface`` (z = 0), ``axis`` (r = 0), ``far``; the
    contact edge (1, 0) is a node.

    Raises
    ------
    MeshError for numbers outside these ranges.
    """
    if not 0.25 <= elements_per_contact <= 64:
        raise MeshError(f"elements_per_contact = {elements_per_contact:g}: accepted 0.25 to 64")
    if not 2 <= far_radius <= 1e6:
        raise MeshError(f"far_radius = {far_radius:g}: accepted 2 to 1e6 contact radii")
    size = 1 / elements_per_contact
    points, triangles = _triangulate(size, min(GROWTH * size, LARGEST_GROWTH), far_radius)
    points[np.abs(points) < 1e-12 * far_radius] = 0.0  # onto the axis and the surface exactly
    mesh = MeshTri(points, triangles)
    return mesh.with_boundaries(
        {
            "surface": lambda x: x[1] == 0.0,
            "axis": lambda x: x[0] == 0.0,
            "far": lambda x: (x[0] > 0.0) & (x[1] < 0.0),
        }
    )


def _triangulate(size: float, growth: float, far_radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Node coordinates (2, n) and triangles (3, m), unused nodes dropped."""
    to_edge, to_axis = "Sqrt((x-1)^2+y^2)", "Sqrt(x^2+y^2)"
    near_edge = f"({size / EDGE_REFINEMENT!r}+{growth!r}*{to_edge})"
    elsewhere = f"({size!r}+{growth / 2!r}*(({to_axis}-1)+Fabs({to_axis}-1)))"
    with session("half_space") as gmsh:
        geometry = gmsh.model.geo
        centre, edge = geometry.addPoint(0, 0, 0), geometry.addPoint(1, 0, 0)
        right, bottom = geometry.addPoint(far_radius, 0, 0), geometry.addPoint(0, -far_radius, 0)
        outline = [
            geometry.addLine(centre, edge),
            geometry.addLine(edge, right),
            geometry.addCircleArc(right, centre, bottom),
            geometry.addLine(bottom, centre),
        ]
        geometry.addPlaneSurface([geometry.addCurveLoop(outline)])
        geometry.synchronize()
        # the smaller of the two sizes
        return triangulated(gmsh, f"({near_edge}+{elsewhere}-Fabs({near_edge}-{elsewhere}))/2")
