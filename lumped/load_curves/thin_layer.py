"""Layers much thinner than the contact is wide: each strip of the layer on its own, or squeezed like a fluid.

The closed forms that the integral equations approach: exponents 2 and 3/2 while the layer can be compressed, 3 and
5/2 once it cannot (Johnson 1985, ISBN 978-0-521-34796-9, chapter 5).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault
from lumped.load_curves.base import LoadCurve
from lumped.load_curves.layer import PointLayer
from lumped.numbers import Real


@dataclass(frozen=True)
class ThinLayer(LoadCurve):
    """A parabola of radius R on a thin layer: a^2 = spread R depth and p = p0 (1 - r^2/a^2)^power.

    p0/E* = hardness depth/h where power = 1, hardness R depth^2/h^3 where it is 2. `plane`: per unit length.
    """

    radius: float
    thickness: float
    plane: bool
    spread: float
    power: int
    hardness: float

    @property
    def exponent(self) -> float:
        """alpha of F = const depth^alpha."""
        return self.power + (0.5 if self.plane else 1.0)

    @property
    def _fullness(self) -> float:
        """Force over p0 a^2, in plane strain over p0 a."""
        return (4.0 / 3.0, 16.0 / 15.0)[self.power - 1] if self.plane else pi / (self.power + 1.0)

    def force(self, depth: ArrayLike) -> Real:
        """F/E*, m^2; per unit length m."""
        a = self.contact_radius(depth)
        return self._fullness * self._peak(np.maximum(depth, 0.0)) * (a if self.plane else a**2)

    def contact_radius(self, depth: ArrayLike) -> Real:
        """sqrt(spread R depth), m."""
        return np.sqrt(self.spread * self.radius * np.maximum(depth, 0.0))

    def depth(self, contact_radius: ArrayLike) -> Real:
        """a^2/(spread R), m."""
        return np.asarray(contact_radius) ** 2 / (self.spread * self.radius)

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """2 a/(spread R)."""
        return 2.0 * np.asarray(contact_radius) / (self.spread * self.radius)

    def dforce_ddepth(self, depth: ArrayLike) -> Real:
        """alpha F/depth."""
        d = np.maximum(np.asarray(depth, dtype=float), 0.0)
        return self.exponent * np.divide(self.force(d), d, out=np.zeros_like(d), where=d > 0.0)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> NDArray[np.float64]:
        """p0 (1 - r^2/a^2)^power."""
        r = np.abs(np.asarray(radius, dtype=float))
        ratio = np.divide(r, contact_radius, out=np.ones_like(r), where=r < contact_radius)
        return np.asarray(self._peak(self.depth(contact_radius)) * (1.0 - ratio**2) ** self.power)

    def _peak(self, depth: Real) -> Real:
        """p0/E*."""
        geometry = 1.0 if self.power == 1 else self.radius / self.thickness
        return self.hardness * geometry * (depth / self.thickness) ** self.power


def compressible(radius: float, layer: PointLayer, *, plane: bool) -> ThinLayer:
    """Winkler's foundation: confined modulus on a bonded base, E* itself on a sliding one; a^2 = 2 R depth.

    Raises BadInput for a bonded layer with nu = 0.5.
    """
    if layer.base == "bonded" and layer.nu == 0.5:
        message = "of a bonded compressible layer must stay below 0.5: its confined modulus is infinite"
        raise BadInput(Fault("layer", "nu", message))
    hardness = (1.0 - layer.nu) ** 2 / (1.0 - 2.0 * layer.nu) if layer.base == "bonded" else 1.0
    return ThinLayer(radius, layer.thickness, plane, 2.0, 1, hardness)


def incompressible(radius: float, layer: PointLayer, *, plane: bool) -> ThinLayer:
    """nu = 0.5 on a bonded base, free to slip under the indenter: a^2 = 4 R depth, in plane strain 6 R depth.

    The layer is pushed outwards between its faces like a fluid: p'' + p'/r = -3 G (depth - r^2/(2R))/h^3, p = p' = 0 at
    the edge. Raises BadInput for any other layer.
    """
    if layer.base != "bonded" or layer.nu != 0.5:
        raise BadInput(Fault("layer", "nu", "must be 0.5, on a bonded base, for an incompressible thin layer"))
    return ThinLayer(radius, layer.thickness, plane, 6.0 if plane else 4.0, 2, 9.0 / 8.0 if plane else 3.0 / 8.0)
