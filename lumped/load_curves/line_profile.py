"""Cylinders with their axis along the surface: the profile of a contact per unit length."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import inf

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault


@dataclass(frozen=True)
class LineProfile(ABC):
    """A symmetric convex profile with this radius of curvature at its lowest line, m. Raises BadInput."""

    radius: float

    def __post_init__(self) -> None:
        if not 0.0 < self.radius < inf:
            raise BadInput(Fault("cylinder", "radius", f"must be above 0 m, is {self.radius}"))

    @property
    @abstractmethod
    def extent(self) -> float:
        """Half-width at which the profile ends, m."""

    @abstractmethod
    def height(self, x: ArrayLike) -> NDArray[np.float64]:
        """Height above the lowest line, m."""


@dataclass(frozen=True)
class CylinderProfile(LineProfile):
    """The true cylinder."""

    @property
    def extent(self) -> float:
        """R, m."""
        return self.radius

    def height(self, x: ArrayLike) -> NDArray[np.float64]:
        """R - sqrt(R^2-x^2) = x^2/(R + sqrt(R^2-x^2)), m."""
        square = np.square(np.asarray(x, dtype=float))
        return np.asarray(square / (self.radius + np.sqrt(self.radius**2 - square)))


@dataclass(frozen=True)
class ParabolaProfile(LineProfile):
    """The parabola of the same curvature."""

    @property
    def extent(self) -> float:
        """It does not end."""
        return inf

    def height(self, x: ArrayLike) -> NDArray[np.float64]:
        """x^2/(2R), m."""
        return np.asarray(np.square(np.asarray(x, dtype=float)) / (2.0 * self.radius))


def hertz_pressure(x: ArrayLike, half_width: float, radius: float) -> NDArray[np.float64]:
    """Hertz's pressure per E* under a parabola x^2/(2R) on the half-plane: sqrt(b^2-x^2)/(2R), zero outside."""
    return np.asarray(np.sqrt(np.maximum(half_width**2 - np.asarray(x, dtype=float) ** 2, 0.0)) / (2.0 * radius))
