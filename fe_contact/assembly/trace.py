"""Quadrature on the contact zone, and the displacement at its points from that of the nodes."""

from __future__ import annotations

from functools import cache

import numpy as np

from fe_contact.assembly.forms import Array

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
