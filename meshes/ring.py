"""A half ring laid flat: its inner surface is the line z = 0, its outer one z = -thickness."""

from __future__ import annotations

from typing import TYPE_CHECKING

from meshes.layer import ZONE, layer

if TYPE_CHECKING:
    from skfem import MeshTri


def ring(elements_per_arc: float, smallest: float, thickness: float, half_circumference: float) -> MeshTri:
    """Triangles of the rectangle ``0 <= x <= half_circumference``, fine at the surface for contact arcs up to one.

    Parameters
    ----------
    elements_per_arc : arc length over element size at the surface, 1 to 200.
    smallest : the smallest contact arc to resolve so, 1e-6 to 1.
    thickness : of the ring, 1e-3 to 1e6.
    half_circumference : of its inner surface, above 1.1.

    Returns
    -------
    MeshTri with coordinates (x, z) and boundaries ``surface`` (inside), ``axis`` (the line of motion), ``base``
    (outside), ``side`` (opposite).

    Raises
    ------
    MeshError for numbers outside these ranges.
    """
    return layer(elements_per_arc, smallest, thickness, half_circumference - ZONE)
