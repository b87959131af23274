"""The contract of a load curve: what an elastic half-space answers to one profile."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.quadrature import gauss

GAUSS_POINTS = 48


class LoadCurve(ABC):
    """Frictionless indentation of the elastic half-space by one convex axisymmetric profile.

    All forces are per unit contact modulus E* = E/(1-nu^2): F/E* in m^2, pressure/E* in 1, energy/E* in m^3.
    Depths and radii in m; arguments are scalars or arrays; a depth below zero counts as zero.
    """

    @abstractmethod
    def force(self, depth: ArrayLike) -> Any:
        """F/E* at a depth."""

    @abstractmethod
    def contact_radius(self, depth: ArrayLike) -> Any:
        """Contact radius a at a depth."""

    @abstractmethod
    def depth(self, contact_radius: ArrayLike) -> Any:
        """Depth at a contact radius."""

    @abstractmethod
    def depth_slope(self, contact_radius: ArrayLike) -> Any:
        """d depth / d a."""

    def dforce_ddepth(self, depth: ArrayLike) -> Any:
        """dF/d depth = 2 a: at the edge the profile meets the surface with the stiffness of a flat punch."""
        return 2.0 * self.contact_radius(depth)

    def force_and_slope(self, depth: ArrayLike) -> tuple[Any, Any]:
        """F/E* and dF/d depth at a depth, for those who need both at every step."""
        return self.force(depth), self.dforce_ddepth(depth)

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
        r = np.abs(np.asarray(radius, dtype=float))
        reach = np.sqrt(np.maximum(contact_radius**2 - r**2, 0.0))
        nodes, weights = gauss(GAUSS_POINTS)
        s = reach[..., None] * nodes
        x = np.hypot(s, r[..., None])
        slope_over_x = np.divide(self.depth_slope(x), x, out=np.zeros_like(x), where=x > 0.0)
        return np.asarray(reach * (slope_over_x @ weights) / np.pi)
