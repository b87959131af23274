"""Half of a cylinder's section, one side of the plane of symmetry."""

from __future__ import annotations

from skfem import MeshTri2

from meshes.sphere import sphere


def cylinder(elements: float, smallest: float, contact: float, order: int) -> MeshTri2:
    """Curved triangles of the half disc ``x >= 0`` of radius 1 about (0, -1); see :func:`meshes.sphere.sphere`."""
    return sphere(elements, smallest, contact, order)
