"""Half a disc, touched at its pole: the section of a sphere, or half of a cylinder's.

Round sections have curved edges and are fine around the point where they are touched first.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshes.triangles import Outline, beyond, checked, distance, elements_checked, filled, larger, smaller, tagged

if TYPE_CHECKING:
    from skfem import MeshTri, MeshTri2

# of elements of order one, of which one lies along the contact's half-width; those of another are so many times larger
GROWTH = 1.25  # growth of the element size per unit distance from the contact
LARGEST = 0.95  # element size over radius
LARGEST_GROWTH, COARSEST = 0.6, 0.5  # of both, whatever is asked
ZONE = 1.1  # the surface is fine up to this multiple of the largest contact
# Element size over radius where the support of a held body ends. There displacements rise with a root of the distance
# of 0.6 to 0.75, which no order of elements follows; what they miss of the body's work falls with its double.
CORNER = 0.001
SMALLEST = 1e-12  # element size over radius, below which rounding takes its digits


def sphere(elements: float, smallest: float, contact: float, order: int, held: bool = False) -> MeshTri2:
    """Curved triangles of the half disc ``x >= 0`` of radius 1 about (0, -1), its middle plane a line of nodes.

    Parameters
    ----------
    elements : along a contact's half-width, 1 to 200.
    smallest : the smallest contact to resolve so, over the largest, 1e-6 to 1.
    contact : angle of the largest contact from its middle, 1e-9 to 1.4 rad.
    order : of the elements on this mesh, 1 to 4: the lower, the smaller those in the bulk.
    held : whether from its middle plane on, at whose rim elements are then small too.

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
    if held:
        size = smaller(size, f"({CORNER * order / n!r}+{growth(n / order)!r}*{distance(1.0, -1.0)})")
    pole, equator, foot, centre = range(4)
    edges = [(centre, equator), (pole, centre), (equator, centre, pole), (centre, foot), (foot, centre, equator)]
    halves = [(2, 1, 3), (4, 5, -1)]  # with the middle plane between them
    corners = [(0, 0), (1, -1), (0, -2), (0, -1)]
    nodes, triangles = filled(corners, edges, halves, size, Outline((0, -2), (1, 0), (0, -1, 1)))
    nodes[0, abs(nodes[0]) < 1e-14] = 0.0  # onto the axis exactly
    nodes[1, abs(nodes[1] + 1.0) < 1e-14] = -1.0  # onto the middle plane
    return rounded(tagged(nodes, triangles, {"surface": lambda x: x[0] > 0.0, "axis": lambda x: x[0] == 0.0}))


def sizes(elements: float, smallest: float, contact: float, order: int) -> str:
    """Element size around the point (0, 0) of a circle of radius 1 about (0, -1), contacts up to ``contact``, rad.

    ``elements`` along a half-width, down to the share ``smallest`` of the largest; twice as many halve the size
    everywhere, in the bulk too. ``order`` of the elements: there those of order 1 are as small as the nodes of others
    lie apart. Raises MeshError for elements so small that they drown in rounding.
    """
    checked("smallest element over radius", smallest * contact / elements, SMALLEST, COARSEST)
    nodes = elements / checked("order of the elements", order, 1, 4)
    largest = min(LARGEST / nodes, COARSEST)
    zone = ZONE * contact
    within = smaller(larger("Fabs(x)", repr(smallest * contact)), repr(zone))
    depth = f"Fabs(1-{distance(0.0, -1.0)})"
    growing = f"(({within})/{elements!r}+{growth(nodes)!r}*({depth}+{beyond(distance(0.0, 0.0), zone)}))"
    return smaller(growing, repr(largest))


def growth(nodes: float) -> float:
    """Of the element size per unit distance from where it is small, with so many ``nodes`` along a contact."""
    return min(GROWTH / nodes, LARGEST_GROWTH)


def rounded(mesh: MeshTri) -> MeshTri2:
    """The same triangles with their edges on ``surface`` bent onto the circle."""
    from skfem import MeshTri2

    bent = MeshTri2.from_mesh(mesh)
    places = bent.doflocs.copy()
    middles = mesh.p.shape[1] + mesh.boundaries["surface"]
    arms = places[:, middles] - np.array([[0.0], [-1.0]])
    places[:, middles] = np.array([[0.0], [-1.0]]) + arms / np.linalg.norm(arms, axis=0)
    return MeshTri2(places, mesh.t).with_boundaries(dict(mesh.boundaries))
