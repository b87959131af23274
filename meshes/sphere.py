"""Half a disc, touched at its pole: the section of a sphere, or half of a cylinder's."""

from __future__ import annotations

from skfem import MeshTri, MeshTri2

from meshes._round import rounded, sizes
from meshes._sizes import checked, elements_checked
from meshes.session import session
from meshes.triangles import Outline, triangulated


def sphere(elements: float, smallest: float, contact: float, order: int) -> MeshTri2:
    """Curved triangles of the half disc ``x >= 0`` of radius 1 about (0, -1), its middle plane a line of nodes.

    Parameters
    ----------
    elements : along a contact's half-width, 1 to 200.
    smallest : the smallest contact to resolve so, over the largest, 1e-6 to 1.
    contact : angle of the largest contact from its middle, 1e-9 to 1.4 rad.
    order : of the elements on this mesh, 1 to 4: the lower, the smaller those in the bulk.

    Returns
    -------
    MeshTri2 with coordinates (r, z) and boundaries ``surface`` (the circle), ``axis`` (x = 0).

    Raises
    ------
    MeshError for numbers outside these ranges.
    """
    n = elements_checked("a contact", elements, 1.0, 200.0)
    low = checked("smallest contact over the largest", smallest, 1e-6, 1.0)
    size = sizes(n, low, checked("angle of the largest contact", contact, 1e-9, 1.4), order)
    with session("sphere") as gmsh:
        geometry = gmsh.model.geo
        corners = ((0, 0), (1, -1), (0, -2), (0, -1))
        pole, equator, foot, centre = (geometry.addPoint(x, y, 0) for x, y in corners)
        middle = geometry.addLine(centre, equator)
        upper = [geometry.addLine(pole, centre), middle, geometry.addCircleArc(equator, centre, pole)]
        lower = [geometry.addLine(centre, foot), geometry.addCircleArc(foot, centre, equator), -middle]
        for outline in (upper, lower):
            geometry.addPlaneSurface([geometry.addCurveLoop(outline)])
        geometry.synchronize()
        nodes, triangles = triangulated(gmsh, size, Outline((0, -2), (1, 0), (0, -1, 1)))
    nodes[0, abs(nodes[0]) < 1e-14] = 0.0  # onto the axis exactly
    nodes[1, abs(nodes[1] + 1.0) < 1e-14] = -1.0  # onto the middle plane
    return rounded(
        MeshTri(nodes, triangles).with_boundaries({"surface": lambda x: x[0] > 0.0, "axis": lambda x: x[0] == 0.0})
    )
