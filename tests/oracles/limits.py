"""Closed forms that load curves approach: line contact far above its datum, layers much thinner than the contact.

Popov's row of the paper's Table 1 beside them, which no body follows.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import e, exp, pi

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import BadInput, Fault, NotReached
from lumped.load_curves.base import LoadCurve
from lumped.load_curves.half_plane import HalfPlane
from lumped.load_curves.layer import PointLayer
from lumped.load_curves.plane_contact import ParabolaProfile
from lumped.numbers import Array, Real


@dataclass(frozen=True)
class Johnson(LoadCurve):
    """Johnson's logarithm for the parabola x^2/(2R), the datum far below the contact: b << d.

    depth = (F/(pi E*)) [2 ln(2d/b) - nu/(1-nu)], F = pi E* b^2/(4R): the greatest
    depth has 2 ln(2d/b) = 1 + nu/(1-nu).
    `radius` R and `datum_depth` d in m, `nu` in (-1, 0.5]. Raises BadInput; NotReached where no half-width answers.
    Johnson 1985, ISBN 978-0-521-34796-9, chapter 5.
    """

    radius: float
    datum_depth: float
    nu: float

    def __post_init__(self) -> None:
        HalfPlane(ParabolaProfile(self.radius), self.datum_depth, self.nu)  # refuses what this refuses

    @property
    def extent(self) -> float:
        """The half-width of the greatest depth, m."""
        return 2.0 * self.datum_depth * exp(-0.5 * (1.0 + self._side))

    @property
    def _side(self) -> float:
        return self.nu / (1.0 - self.nu)

    def force(self, depth: ArrayLike) -> Real:
        """F/E* per unit length, m."""
        return self.force_at(self.contact_radius(depth))

    def force_at(self, contact_radius: ArrayLike) -> Real:
        """pi b^2/(4R), m."""
        return 0.25 * pi * np.asarray(contact_radius) ** 2 / self.radius

    def contact_radius(self, depth: ArrayLike) -> Real:
        """Half-width b, m: b^2 ln(b^2/B) = -4 R depth, B = 4 d^2 exp(-nu/(1-nu)), by Lambert's lower branch."""
        from scipy.special import lambertw

        square = 4.0 * self.datum_depth**2 * exp(-self._side)
        depth = np.asarray(depth, dtype=float)
        share = 4.0 * self.radius * np.maximum(depth, 0.0) / square
        if np.max(share, initial=0.0) > 1.0 / e:
            raise NotReached(
                f"no contact on the half-plane is {np.max(depth):g} m deep: its half-width nears the datum's depth"
            )
        answer = np.real(lambertw(-np.where(share > 0.0, share, 0.1), -1))
        return np.where(share > 0.0, np.sqrt(square * np.exp(answer)), 0.0)

    def depth(self, contact_radius: ArrayLike) -> Real:
        """(b^2/(4R)) [2 ln(2d/b) - nu/(1-nu)], m."""
        b = np.asarray(contact_radius, dtype=float)
        return 0.25 * b**2 / self.radius * (self._logarithm(b) - self._side)

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """(b/(2R)) [2 ln(2d/b) - 1 - nu/(1-nu)]."""
        b = np.asarray(contact_radius, dtype=float)
        return 0.5 * b / self.radius * (self._logarithm(b) - 1.0 - self._side)

    def force_and_slope(self, depth: ArrayLike) -> tuple[Real, Real]:
        """F/E* and pi/[2 ln(2d/b) - 1 - nu/(1-nu)]: a flat punch's, as far as the datum is far."""
        b = np.asarray(self.contact_radius(depth))
        return self.force(depth), np.where(b > 0.0, pi / (self._logarithm(b) - 1.0 - self._side), 0.0)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> Array:
        """sqrt(b^2-x^2)/(2R)."""
        return hertz_pressure(radius, contact_radius, self.radius)

    def _logarithm(self, b: Array) -> Array:
        """2 ln(2d/b), 0 without contact."""
        return 2.0 * np.log(2.0 * self.datum_depth / np.where(b > 0.0, b, 2.0 * self.datum_depth))


@dataclass(frozen=True)
class Popov(LoadCurve):
    """The row F = (pi/4) E* l depth of the paper's Table 1, here per unit length, with b^2 = R depth: a heuristic.

    It takes the approach of a sphere for that of a cylinder, which has none; no body follows it at more than one depth.
    `radius` R in m. Popov 2010, ISBN 978-3-642-10802-0, chapter 5.
    """

    radius: float

    def force(self, depth: ArrayLike) -> Real:
        """(pi/4) depth, m."""
        return 0.25 * pi * np.maximum(depth, 0.0)

    def contact_radius(self, depth: ArrayLike) -> Real:
        """sqrt(R depth), m."""
        return np.sqrt(self.radius * np.maximum(depth, 0.0))

    def depth(self, contact_radius: ArrayLike) -> Real:
        """b^2/R, m."""
        return np.asarray(contact_radius) ** 2 / self.radius

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """2 b/R."""
        return 2.0 * np.asarray(contact_radius) / self.radius

    def force_and_slope(self, depth: ArrayLike) -> tuple[Real, Real]:
        """(pi/4) depth, m, and pi/4."""
        return self.force(depth), np.where(np.asarray(depth) >= 0.0, 0.25 * pi, 0.0)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> Array:
        """sqrt(b^2-x^2)/(2R)."""
        return hertz_pressure(radius, contact_radius, self.radius)


def hertz_pressure(x: ArrayLike, half_width: float, radius: float) -> Array:
    """Hertz's pressure per E* under a parabola x^2/(2R) on the half-plane: sqrt(b^2-x^2)/(2R), zero outside."""
    return np.asarray(np.sqrt(np.maximum(half_width**2 - np.asarray(x, dtype=float) ** 2, 0.0)) / (2.0 * radius))


@dataclass(frozen=True)
class ThinLayer(LoadCurve):
    """A parabola of radius R on a layer much thinner than the contact is wide: each strip on its own, or squeezed out.

    The closed forms that the integral equations approach, with a^2 = spread R depth and p = p0 (1 - r^2/a^2)^power:
    exponents 2 and 3/2 while the layer can be compressed, 3 and 5/2 once it cannot (Johnson 1985, ISBN
    978-0-521-34796-9, chapter 5).
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

    def force_and_slope(self, depth: ArrayLike) -> tuple[Real, Real]:
        """F/E* and alpha F/(E* depth)."""
        d = np.maximum(np.asarray(depth, dtype=float), 0.0)
        return self.force(d), self.exponent * np.divide(self.force(d), d, out=np.zeros_like(d), where=d > 0.0)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> Array:
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
