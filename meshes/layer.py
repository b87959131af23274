"""A layer on a rigid base under a contact that may end anywhere: the mesh of an axisymmetric layer.

Its thickness is a length of its own, so one mesh serves every depth: elements at the surface grow in proportion
to the radius, and every contact circle is resolved alike.
"""

from __future__ import annotations

from skfem import MeshTri

from meshes.errors import MeshError
from meshes.session import session
from meshes.triangles import triangulated

GROWTH = 0.4  # growth of the element size per unit distance from the surface, and from the contact outwards
LARGEST = 0.7  # element size over thickness
ZONE = 1.1  # the surface is fine up to this radius


def layer(elements_per_radius: float, smallest: float, thickness: float, width: float) -> MeshTri:
    """Triangles of the layer ``-thickness <= z <= 0``, ``r <= 1.1 + width``, fine for contact radii up to one.

    Parameters
    ----------
    elements_per_radius : radius over element size at the surface, 1 to 200.
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
    for name, value, low, high in (
        ("elements_per_radius", elements_per_radius, 1.0, 200.0),
        ("smallest", smallest, 1e-6, 1.0),
        ("thickness", thickness, 1e-3, 1e6),
        ("width", width, 1e-3, 1e8),
    ):
        if not low <= value <= high:
            raise MeshError(f"{name} = {value:g}: accepted {low:g} to {high:g}")
    smallest, thickness, side = float(smallest), float(thickness), ZONE + float(width)  # gmsh reads their digits
    within = f"(x+{smallest!r}+Fabs(x-{smallest!r}))/2"  # the larger of the two
    within = f"({within}+{ZONE!r}-Fabs({within}-{ZONE!r}))/2"
    beyond = f"(x-{ZONE!r}+Fabs(x-{ZONE!r}))/2"
    growing = f"(({within})/{float(elements_per_radius)!r}+{GROWTH!r}*(Fabs(y)+{beyond}))"
    size = f"({growing}+{LARGEST * thickness!r}-Fabs({growing}-{LARGEST * thickness!r}))/2"
    with session("layer") as gmsh:
        geometry = gmsh.model.geo
        corners = [(0, 0), (ZONE, 0), (side, 0), (side, -thickness), (0, -thickness)]
        points = [geometry.addPoint(r, z, 0) for r, z in corners]
        lines = [geometry.addLine(points[i], points[(i + 1) % len(points)]) for i in range(len(points))]
        geometry.addPlaneSurface([geometry.addCurveLoop(lines)])
        geometry.synchronize()
        nodes, triangles = triangulated(gmsh, size)
    nodes[abs(nodes) < 1e-12 * side] = 0.0  # onto the axis and the surface exactly
    return MeshTri(nodes, triangles).with_boundaries(
        {
            "surface": lambda x: x[1] == 0.0,
            "axis": lambda x: x[0] == 0.0,
            "base": lambda x: x[1] < -thickness * (1 - 1e-9),
            "side": lambda x: x[0] > side * (1 - 1e-9),
        }
    )
