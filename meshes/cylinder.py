"""Half of a cylinder's section, one side of the plane of symmetry."""

from __future__ import annotations

from typing import TYPE_CHECKING

from meshes.sphere import sphere

if TYPE_CHECKING:
    from skfem import MeshTri2


def cylinder(elements: float, smallest: float, contact: float, order: int, held: bool = False) -> MeshTri2:
    """Curved triangles of the half disc ``x >= 0`` of radius 1 about (0, -1), as of :func:`meshes.sphere.sphere`.

    Parameters
    ----------
    elements : along a contact's half-width, 1 to 200.
    smallest : the smallest contact to resolve so, over the largest, 1e-6 to 1.
    contact : angle of the largest contact from its middle, 1e-9 to 1.4 rad.
    order : of the elements on this mesh, 1 to 4.
    held : whether from its middle plane on.

    Raises
    ------
    MeshError for numbers outside these ranges.
    """
    return sphere(elements, smallest, contact, order, held)
