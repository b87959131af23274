"""Tabulated line contact: the logarithm that every plane curve carries is taken out of its table."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.load_curves.plane_contact import Array, Grown
from lumped.load_curves.tabulated import TabulatedCurve, TabulatedState


class LineCurve(TabulatedCurve):
    """Plane strain, per unit length. With half-width b, a radius of curvature R and a length h,
    F/E* = pi b^2/(4 R f), depth = (F/E*) [(2/pi) ln(h/b) + d], d depth/dF = (2/pi) ln(h/b) + c,
    and f, d and c are smooth down to b = 0, where f = 1.
    """

    @property
    @abstractmethod
    def curvature_radius(self) -> float:
        """R of the undeformed gap, m."""

    @property
    @abstractmethod
    def length(self) -> float:
        """h, m."""

    @abstractmethod
    def grown(self, half_width: float, refinement: float) -> Grown:
        """The contact at one half-width."""

    def sample(self, contact_radius: float, refinement: float) -> Array:
        """f, d and c."""
        here = self.grown(contact_radius, refinement)
        logarithm = 2.0 / np.pi * np.log(self.length / contact_radius)
        hertz = np.pi * contact_radius**2 / (4.0 * self.curvature_radius)
        return np.array([hertz / here.force, here.depth / here.force - logarithm, here.compliance - logarithm])

    def state(self, contact_radius: Array, smooth: Array, slopes: Array) -> TabulatedState:
        """The curve from f, d and c; at b = 0 all is 0."""
        b, touched = np.where(contact_radius > 0.0, contact_radius, self.length), contact_radius > 0.0
        logarithm = 2.0 / np.pi * np.log(self.length / b)
        force = np.pi * b**2 / (4.0 * self.curvature_radius * smooth[0])
        force_slope = force * (2.0 / b - slopes[0] / smooth[0])
        compliance = logarithm + smooth[1]
        slope = force_slope * compliance + force * (slopes[1] - 2.0 / (np.pi * b))
        values = (force * compliance, slope, force, 1.0 / (logarithm + smooth[2]))
        return TabulatedState(*(np.where(touched, value, 0.0) for value in values))

    def pressure(self, radius: ArrayLike, contact_radius: float) -> NDArray[np.float64]:
        """p/E* at distances from the middle of the contact, from the equation itself; zero at first touch."""
        if contact_radius == 0.0:
            return np.zeros(np.shape(radius))
        here = self.grown(contact_radius, 1.0)
        return here.collocation.at(here.q, np.asarray(radius, dtype=float) / contact_radius)
