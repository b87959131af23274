"""Where contact may happen: the nodes of a boundary, in order, with normals and a measure, and quadrature on them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from fe_contact.assembly.forms import Array, Basis, Indices

MIDDLE = 0.5 * np.pi - 1e-6  # rad from the top of a circle: just above its middle plane
CONTACT_ZONE = 1.1  # contact is sought up to this multiple of the predicted contact radius


@dataclass(frozen=True, eq=False)
class Surface:
    """Scalar degrees of freedom (n_s,) along a boundary and their coordinate (n_s,), ascending from the first touch.

    ``normal`` (n_s, 2) out of the body; ``measure`` area per unit of the coordinate, and ``motion`` the component of
    the inward normal along the striker's motion, at coordinates of any shape; ``zone``: contact is sought up to
    there. ``dimension``: 3, forces in modulus x length^2, or 2, per unit length in modulus x length.
    """

    dofs: Indices
    coordinate: Array
    normal: Array
    measure: Callable[[Array], Array]
    motion: Callable[[Array], Array]
    zone: float
    dimension: int

    def corners(self, order: int, end: float | None = None) -> Array:
        """Ends of whole facets of elements of an order, ascending, up to the end of the zone, or another, at least."""
        corners = self.coordinate[::order]
        return corners[: np.searchsorted(corners, self.zone if end is None else end) + 1]

    def loaded(self, order: int) -> int:
        """How many of the first nodes, of elements of an order, lie in the zone: those that may be pressed on."""
        return order * (len(self.corners(order)) - 1) + 1

    def quadrature(self, order: int) -> tuple[Array, Array, Array]:
        """Points of the zone and their areas, each (q,), and the displacement there from that of its nodes, (q, n)."""
        points, lengths, trace = contact_quadrature(self.corners(order), order)
        return points, lengths * self.measure(points), trace


def flat(basis: Basis, dimension: int = 3, motion: Callable[[Array], Array] = np.ones_like) -> Surface:
    """The boundary ``surface`` of a mesh, z = 0, from the axis (or the plane of symmetry, of both halves) outwards."""
    dofs = basis.get_dofs("surface").flatten()
    dofs = dofs[np.argsort(basis.doflocs[0, dofs])]
    return Surface(
        dofs=dofs,
        coordinate=basis.doflocs[0, dofs],
        normal=np.tile([0.0, 1.0], (dofs.size, 1)),
        measure=ring_area if dimension == 3 else both_halves,
        motion=motion,
        zone=CONTACT_ZONE,
        dimension=dimension,
    )


def face(basis: Basis, rim: float) -> Surface:
    """The same up to the ``rim`` of a flat end, and no facet more."""
    return replace(flat(basis), zone=rim * (1.0 - 1e-12))


def crown(basis: Basis, contact: float, mean_radius: float | None) -> Surface:
    """The boundary ``surface`` of a circle of radius 1, by its angle from the top, rad, where ``contact`` may end.

    The pressure is vertical and acts on what the circle shows from above: ``mean_radius`` is its distance from the
    axis, where the left of the top counts too, 0 on the axis, None in plane strain. The circle's top is the mesh's.
    """
    dofs = basis.get_dofs("surface").flatten()
    places = basis.doflocs[:, dofs]
    angle = np.arctan2(places[0] - (mean_radius or 0.0), places[1] + 1.0)
    ascending, order = np.argsort(angle), basis.elem.maxdeg
    corners = angle[ascending][::order]
    above = np.flatnonzero(np.abs(corners) < MIDDLE)  # the middle plane may be held, and then gives way to no pressure
    zone = min(CONTACT_ZONE * contact, float(corners[above[-1]]))
    first = max(int(np.searchsorted(corners, -zone)) - 1, int(above[0]))
    chosen = ascending[first * order :]
    return Surface(
        dofs=dofs[chosen],
        coordinate=angle[chosen],
        normal=np.tile([0.0, 1.0], (chosen.size, 1)),
        measure=lambda angle: np.cos(angle) * _breadth(angle, mean_radius),
        motion=np.ones_like,
        zone=zone,
        dimension=2 if mean_radius is None else 3,
    )


def _breadth(angle: Array, mean_radius: float | None) -> Array:
    """Area of a band over its width seen from above."""
    return both_halves(angle) if mean_radius is None else ring_area(mean_radius + np.sin(angle))


def ring_area(radius: Array) -> Array:
    """2 pi r."""
    return np.asarray(2.0 * np.pi * radius)


def both_halves(coordinate: Array) -> Array:
    """2: the other side of a plane of symmetry counts too."""
    return np.full_like(coordinate, 2.0)


FACET_POINTS = 4  # quadrature points a facet beyond the element order: the contact edge is a kink


def contact_quadrature(corners: Array, order: int) -> tuple[Array, Array, Array]:
    """Gauss points, weights in the coordinate, and Lagrange trace on the facets between ``corners``."""
    gauss, weight = np.polynomial.legendre.leggauss(order + FACET_POINTS)
    left, length = corners[:-1, None], np.diff(corners)[:, None]
    points = (left + length * (gauss + 1) / 2).ravel()
    weights = (length * weight / 2).ravel()
    local = lagrange((gauss + 1) / 2, order)
    trace = np.zeros((len(points), (len(corners) - 1) * order + 1))
    for facet in range(len(corners) - 1):
        rows = slice(facet * len(gauss), (facet + 1) * len(gauss))
        trace[rows, facet * order : (facet + 1) * order + 1] = local
    return points, weights, trace


def hats(count: int, order: int) -> Array:
    """Linear shape functions of the facets at so many points of a quadrature as above, (q, corners)."""
    gauss, _ = np.polynomial.legendre.leggauss(order + FACET_POINTS)
    corners = np.arange(count // gauss.size + 1.0)
    return trace_between(corners, (corners[:-1, None] + (gauss + 1) / 2).ravel(), 1)


def trace_between(corners: Array, points: Array, order: int) -> Array:
    """Displacement at points (q,) anywhere on the facets between ``corners`` from that of their nodes, (q, n)."""
    facet = np.clip(np.searchsorted(corners, points) - 1, 0, len(corners) - 2)
    local = lagrange((points - corners[facet]) / (corners[facet + 1] - corners[facet]), order)
    trace = np.zeros((len(points), (len(corners) - 1) * order + 1))
    trace[np.arange(len(points))[:, None], order * facet[:, None] + np.arange(order + 1)] = local
    return trace


def lagrange(x: Array, order: int) -> Array:
    """Equispaced Lagrange polynomials on [0, 1] at ``x``, shape (len(x), order + 1)."""
    return np.vander(x, order + 1, increasing=True) @ monomials(order)


@cache
def monomials(order: int) -> Array:
    """Coefficients (power, function) of the equispaced Lagrange polynomials on [0, 1]."""
    nodes: Array = np.arange(order + 1) / order
    return np.asarray(np.linalg.inv(np.vander(nodes, increasing=True)), dtype=np.float64)
