"""Contact over an area which no depth changes: the flat-ended indenter, and its half-space."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import BadInput, Fault
from lumped.load_curves.base import LoadCurve
from lumped.numbers import Array, Real


class FixedArea(LoadCurve):
    """A linear curve F = S depth: the whole flat end of half-width or `radius` touches at once."""

    radius: float
    closed: ClassVar[bool] = True

    @property
    @abstractmethod
    def stiffness(self) -> float:
        """S/E*: 2 a on the half-space."""

    @property
    def extent(self) -> float:
        """The radius of the end, m."""
        return self.radius

    def force(self, depth: ArrayLike) -> Real:
        """S depth."""
        return self.stiffness * np.maximum(depth, 0.0)

    def contact_radius(self, depth: ArrayLike) -> Real:
        """The radius of the end wherever there is depth, m."""
        return np.where(np.asarray(depth) > 0.0, self.radius, 0.0)

    def depth(self, contact_radius: ArrayLike) -> Real:
        """The least depth with this contact radius, m: 0, infinite beyond the end."""
        return np.where(np.asarray(contact_radius) <= self.radius, 0.0, np.inf)

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """0, infinite beyond the end."""
        return self.depth(contact_radius)

    def force_and_slope(self, depth: ArrayLike) -> tuple[Real, Real]:
        """S depth, and S."""
        return self.force(depth), np.where(np.asarray(depth) >= 0.0, self.stiffness, 0.0)

    def energy(self, depth: ArrayLike) -> Array:
        """S depth^2/2."""
        return np.asarray(0.5 * self.stiffness * np.maximum(depth, 0.0) ** 2)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> Array:
        """Raises BadInput: the radius of this contact does not tell its depth."""
        message = "does not determine the pressure under a flat end; ask pressure_at(radius, depth)"
        raise BadInput(Fault("punch", "contact_radius", message))

    @abstractmethod
    def pressure_at(self, radius: ArrayLike, depth: float) -> Array:
        """Pressure p/E* at a distance from the axis, infinite at the edge and zero beyond."""


@dataclass(frozen=True)
class PunchCurve(FixedArea):
    """The half-space under a flat-ended cylinder of this radius: F = 2 E* a depth (Boussinesq 1885)."""

    radius: float

    @property
    def stiffness(self) -> float:
        """2 a, m."""
        return 2.0 * self.radius

    def pressure_at(self, radius: ArrayLike, depth: float) -> Array:
        """depth/(pi sqrt(a^2-r^2))."""
        return under_flat_end(radius, self.radius, max(depth, 0.0))


def under_flat_end(radius: ArrayLike, end: float, intensity: float) -> Array:
    """intensity/(pi sqrt(a^2-r^2)) below a flat end of radius a, infinite at its edge and zero beyond."""
    square = end**2 - np.asarray(radius, dtype=float) ** 2
    with np.errstate(divide="ignore"):
        return np.where(square < 0.0, 0.0, intensity / (np.pi * np.sqrt(np.maximum(square, 0.0))))


@dataclass(frozen=True)
class Column(FixedArea):
    """A block of circular section of this radius and of this thickness, m, strained alike everywhere.

    F = M A depth/thickness, where all that is per unit E* elsewhere is per unit of its own modulus M: Young's
    under uniaxial stress, the confined one under uniaxial strain (Table 1, rows 1 and 2).
    """

    radius: float
    thickness: float

    @property
    def stiffness(self) -> float:
        """A/thickness, m."""
        return float(np.pi) * self.radius**2 / self.thickness

    def pressure_at(self, radius: ArrayLike, depth: float) -> Array:
        """depth/thickness on the whole face."""
        return np.where(np.abs(np.asarray(radius)) <= self.radius, max(depth, 0.0) / self.thickness, 0.0)
