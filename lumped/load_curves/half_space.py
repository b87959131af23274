"""The elastic half-space under a convex axisymmetric profile: what all its closed forms share."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.load_curves.base import GAUSS_POINTS, LoadCurve
from lumped.numbers import Real
from lumped.numbers.quadrature import gauss


class HalfSpaceCurve(LoadCurve):
    """A curve of the half-space. Its depth(a) is the one-dimensional profile g(a) = a int_0^a h'(r)/sqrt(a^2-r^2) dr
    of the indenter (Sneddon 1965, doi 10.1016/0020-7225(65)90019-4).
    """

    def dforce_ddepth(self, depth: ArrayLike) -> Real:
        """2 a."""
        return 2.0 * self.contact_radius(depth)

    def energy(self, depth: ArrayLike) -> NDArray[np.float64]:
        """Work of indentation int_0^depth F d depth = depth (F - a depth) + int_0^a depth(x)^2 dx."""
        d = np.maximum(np.asarray(depth, dtype=float), 0.0)
        a = np.asarray(self.contact_radius(d))
        nodes, weights = gauss(GAUSS_POINTS)
        inner = a * (np.square(self.depth(a[..., None] * nodes)) @ weights)
        return np.asarray(d * (self.force(d) - a * d) + inner)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> NDArray[np.float64]:
        """Pressure p(r)/E* = (1/pi) int_r^a depth'(x)/sqrt(x^2-r^2) dx, zero outside the contact.

        Popov and Hess 2015, ISBN 978-3-642-53876-6.
        """
        r = np.minimum(np.abs(np.asarray(radius, dtype=float)), contact_radius)
        reach = np.sqrt(np.maximum(contact_radius**2 - r**2, 0.0))
        nodes, weights = gauss(GAUSS_POINTS)
        s = reach[..., None] * nodes
        x = np.hypot(s, r[..., None])
        slope_over_x = np.divide(self.depth_slope(x), x, out=np.zeros_like(x), where=x > 0.0)
        return np.asarray(reach * (slope_over_x @ weights) / np.pi)
