"""From gmsh's open model to plain arrays of triangles."""

from __future__ import annotations

from typing import Any

import numpy as np


def triangulated(gmsh: Any, size: str) -> tuple[np.ndarray, np.ndarray]:
    """Mesh the open model with an element size over (x, y); node coordinates (2, n) and triangles (3, m).

    Nodes of no triangle are dropped.
    """
    meshing = gmsh.model.mesh
    field = meshing.field.add("MathEval")
    meshing.field.setString(field, "F", size)
    meshing.field.setAsBackgroundMesh(field)
    meshing.generate(2)
    tags, coordinates, _ = meshing.getNodes()
    kinds, _, connectivity = meshing.getElements(2)
    corners = connectivity[list(kinds).index(2)].astype(int)
    used, triangles = np.unique(corners, return_inverse=True)
    row_of_tag = np.zeros(int(tags.max()) + 1, dtype=int)
    row_of_tag[tags.astype(int)] = np.arange(len(tags))
    points = coordinates.reshape(-1, 3)[row_of_tag[used], :2].T
    return np.ascontiguousarray(points), np.ascontiguousarray(triangles.reshape(-1, 3).T)
