"""Small strains of the half-plane under a cylinder, and of a force at its datum, by complex potentials.

With z = x + i y, the body where y < 0, and G = 1 (Muskhelishvili, Some Basic Problems of the Mathematical Theory of
Elasticity, 1953):

s_xx + s_yy = 4 Re phi ,  s_yy - s_xx + 2 i s_xy = 2 (conj(z) phi' + psi) ,
2 d(u + i v)/dx = (3 - 4 nu) phi - conj(phi) - z conj(phi') - conj(psi)
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import asinh, hypot, pi

import numpy as np
import numpy.typing as npt

from lumped.numbers import Array, gauss
from lumped.targets._strains import LAST_NU, StrainField

Complex = npt.NDArray[np.complex128]
CUBIC = 2.5  # power of the force by which the cubic terms' energy goes: p^3 a^2 with p ~ a and the force ~ p a
GAP = 8.0 / 45.0  # of p^3 a^2 (1 - 2 nu) (1 - nu)/G^2: Hertz's pressure p times the slope times what moves along it
# Distances from the first touch, in half-widths, between which points are spread: the end of the contact, and the datum
# with shares of its depth; each is twice the one before at most. Strains are followed to so many depths of the datum.
NEAR, BESIDE_DATUM, FARTHEST = (0.5, 0.9, 1.0, 1.1, 1.5), (0.7, 1.0, 1.4), 100.0
POINTS, ANGLES = 8, 12  # work: along the distance between two of them, and along the angle


def half_plane_strains(nu: float, depth: float, half_width: float, datum: float) -> StrainField:
    """Of Hertz's pressure at a `depth` below a `datum`, all in m; lengths in half-widths.

    By the reciprocal theorem the datum goes down, by what is of second order in the strains, as these meet the strains
    of a unit force at the datum; the force at a depth falls as if it were less deep by so much.
    """
    nu, below = min(nu, LAST_NU), datum / half_width
    root = hypot(1.0, below)
    left = 1.0 / (root + below)  # root - below, to all digits
    sunk = (1.0 - nu) * asinh(below) - nu * below * left  # 2 G depth/(p a)
    slope = ((1.0 - nu) * below - nu * below * left**2) / root
    pressure = 2.0 * depth / half_width / sunk
    force, stiffening = 0.5 * pi * pressure, 2.0 / (2.0 - slope / sunk)  # a power of the depth
    z, area = _points(below)
    return StrainField(
        nu,
        gradient=pressure * _hertz(z).gradient(nu),
        volume=area,
        energy=force * depth / half_width / (1.0 + stiffening),
        gap=GAP * (1.0 - 2.0 * nu) * (1.0 - nu) * pressure**3,
        power=1.0 + stiffening,
        growth=(CUBIC - 1.0) * stiffening - 1.0,
        datum=force / CUBIC * _buried_force(z, -1j * below, nu).gradient(nu),
    )


@dataclass(frozen=True, eq=False)
class Potentials:
    """phi, its derivative and psi at points z, each (n,)."""

    z: Complex
    phi: Complex
    slope: Complex
    psi: Complex

    def __add__(self, other: Potentials) -> Potentials:
        return Potentials(self.z, self.phi + other.phi, self.slope + other.slope, self.psi + other.psi)

    def gradient(self, nu: float) -> Array:
        """Of the displacement, in components (rr, rz, zr, zz, tt), (5, n)."""
        along = (3.0 - 4.0 * nu) * self.phi - self.phi.conj() - self.z * self.slope.conj() - self.psi.conj()
        both, turned = 4.0 * self.phi.real, 2.0 * (self.z.conj() * self.slope + self.psi)
        pressed, sheared = 0.5 * (both + turned.real), 0.5 * turned.imag
        stretch, turn = 0.5 * along.real, 0.5 * along.imag
        return np.stack([stretch, sheared - turn, turn, 0.5 * (pressed - nu * both), np.zeros_like(stretch)])


def _hertz(z: Complex) -> Potentials:
    """Of a pressure sqrt(1 - x^2)."""
    root = np.sqrt(z - 1.0) * np.sqrt(z + 1.0)
    phi = 0.5j / (z + root)  # z - root = 1/(z + root)
    slope = -phi / root
    return Potentials(z, phi, slope, -z * slope)


def _buried_force(z: Complex, place: complex, nu: float) -> Potentials:
    """Of a unit force downwards at a ``place`` inside, and what takes its stresses from the surface."""
    whole, share = -1j / (8.0 * pi * (1.0 - nu)), 3.0 - 4.0 * nu
    own, image = z - place, z - place.conjugate()
    alone = Potentials(
        z, -whole / own, whole / own**2, share * np.conj(whole) / own - whole * place.conjugate() / own**2
    )
    # F*(z) = conj(F(conj z)) of those: no surface stress by phi_2 = -(z phi*)' - psi*, psi_2 = -phi* - (z phi_2)'.
    mirrored, first, second = (sign * np.conj(whole) / image**power for sign, power in ((-1.0, 1), (1.0, 2), (-2.0, 3)))
    psi = share * whole / image - np.conj(whole) * place / image**2
    psi_slope = -share * whole / image**2 + 2.0 * np.conj(whole) * place / image**3
    phi = -(mirrored + z * first + psi)
    slope = -(2.0 * first + z * second + psi_slope)
    return alone + Potentials(z, phi, slope, -(mirrored + phi + z * slope))


def _points(below: float) -> tuple[Complex, Array]:
    """Points of one half of the half-plane, and the areas of both halves that they stand for, each (n,)."""
    edges = sorted({0.0, *NEAR, *(share * below for share in BESIDE_DATUM), FARTHEST * max(below, 1.0)})
    edges = [place for low, high in pairwise(edges) for place in _doubling(low, high)] + edges[-1:]
    (share, weight), (turn, wide) = gauss(POINTS), gauss(ANGLES)
    low, long = np.array(edges[:-1]), np.diff(edges)
    distance, across = (low[:, None] + np.outer(long, share)).ravel(), np.outer(long, weight).ravel()
    angle = 0.5 * pi * turn
    area = 2.0 * np.outer(distance * across, 0.5 * pi * wide)
    return np.asarray(np.outer(distance, np.exp(-1j * angle)).ravel()), area.ravel()


def _doubling(low: float, high: float) -> list[float]:
    """From a place towards a higher one, each twice the one before at most."""
    places = [low]
    while places[-1] > 0.0 and 2.0 * places[-1] < high:
        places.append(2.0 * places[-1])
    return places
