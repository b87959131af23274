"""Round sections with curved edges, fine around the point where they are touched first."""

from __future__ import annotations

import numpy as np
from skfem import MeshTri, MeshTri2

from meshes._sizes import beyond, checked, distance, larger, smaller

# of elements of order one, of which one lies along the contact's half-width; those of another are so many times larger
GROWTH = 1.25  # growth of the element size per unit distance from the contact
LARGEST = 0.95  # element size over radius
LARGEST_GROWTH, COARSEST = 0.6, 0.5  # of both, whatever is asked
ZONE = 1.1  # the surface is fine up to this multiple of the largest contact
SMALLEST = 1e-12  # element size over radius, below which rounding takes its digits


def sizes(elements: float, smallest: float, contact: float, order: int) -> str:
    """Element size around the point (0, 0) of a circle of radius 1 about (0, -1), contacts up to ``contact``, rad.

    ``elements`` along a half-width, down to the share ``smallest`` of the largest; twice as many halve the size
    everywhere, in the bulk too. ``order`` of the elements: there those of order 1 are as small as the nodes of others
    lie apart. Raises MeshError for elements so small that they drown in rounding.
    """
    checked("smallest element over radius", smallest * contact / elements, SMALLEST, COARSEST)
    nodes = elements / checked("order of the elements", order, 1, 4)
    growth, largest = min(GROWTH / nodes, LARGEST_GROWTH), min(LARGEST / nodes, COARSEST)
    zone = ZONE * contact
    within = smaller(larger("Fabs(x)", repr(smallest * contact)), repr(zone))
    depth = f"Fabs(1-{distance(0.0, -1.0)})"
    growing = f"(({within})/{elements!r}+{growth!r}*({depth}+{beyond(distance(0.0, 0.0), zone)}))"
    return smaller(growing, repr(largest))


def rounded(mesh: MeshTri) -> MeshTri2:
    """The same triangles with their edges on ``surface`` bent onto the circle."""
    bent = MeshTri2.from_mesh(mesh)
    places = bent.doflocs.copy()
    middles = mesh.p.shape[1] + mesh.boundaries["surface"]
    arms = places[:, middles] - np.array([[0.0], [-1.0]])
    places[:, middles] = np.array([[0.0], [-1.0]]) + arms / np.linalg.norm(arms, axis=0)
    return MeshTri2(places, mesh.t).with_boundaries(dict(mesh.boundaries))
