"""What friction adds to a normal contact: surfaces of unlike bodies slip on each other as they are pressed together.

Where they do not, each body is sheared against the other, and the same depth takes a larger force. A surface that
never slips is the most there can be: by growing steps of a flat punch that sticks (Spence 1968,
Proc. R. Soc. A 305, 55; Borodich and Keer 2004, Proc. R. Soc. A 460, 507), whose Abel transform of the pressure is

    phi(t) = cos(epsilon ln((1 + t)/(1 - t)))/sqrt(1 - beta^2) ,    epsilon = artanh(beta)/pi ,

for a punch of radius and depth one, E* = 1: of its force 2 artanh(beta)/beta, and outside of it, where no shear of the
surface moves it up or down, the surface sinks by w(r) = 2/pi int_0^1 phi(t)/sqrt(r^2 - t^2) dt.
"""

from __future__ import annotations

import math

import numpy as np

from lumped.materials.material import Material
from lumped.numbers import Array

NODES = 48  # of Gauss: both integrals to 1e-6, as twice as many tell
# Power of a profile from which on it counts as flat. That adds the most, for slip a tenth more than this power; beyond
# it, where beta is large, differences of depths lose their digits.
FLATTEST = 30.0


def mismatch(body: Material, striking: Material | None) -> float:
    """Dundurs' second parameter beta of a body and what strikes it, None: rigid; 0 of like ones, at most 1/2, or 3/4
    where nu is negative.

    Of the moduli at once; the larger one against something rigid where one of them is a dashpot alone.
    """
    alone = [_against_rigid(one) for one in (body, striking) if one is not None]
    own, other = (0.0 if one is None else one.shear.glassy for one in (body, striking))
    if striking is None or own * other == 0.0:
        return max(alone)
    apart = (1.0 - 2.0 * body.nu) * other - (1.0 - 2.0 * striking.nu) * own
    return abs(apart) / (2.0 * ((1.0 - body.nu) * other + (1.0 - striking.nu) * own))


def _against_rigid(material: Material) -> float:
    return (1.0 - 2.0 * material.nu) / (2.0 * (1.0 - material.nu))


def stuck(beta: float, power: float) -> float:
    """Force over that without friction at the same depth, under a profile r^power where nothing ever slips.

    ``power`` infinite: a flat punch.
    """
    if beta == 0.0:
        return 1.0
    stiffer = math.atanh(beta) / beta
    return stiffer if power > FLATTEST else stiffer * (_sinking(beta, power) / _sinking(0.0, power)) ** (-1.0 / power)


def _sinking(beta: float, power: float) -> float:
    """Depth over that of the profile at the contact's edge: what grown punches leave of r^power is nothing there."""
    t, weight = _inside()
    epsilon = math.atanh(beta) / math.pi
    density = np.cos(epsilon * np.log((1.0 + t) / (1.0 - t))) / math.sqrt(1.0 - beta**2)
    s = t[:, None]
    kernel = (weight * t**power) @ (1.0 / np.sqrt(1.0 - (s * t) ** 2))
    return float(1.0 / (1.0 - power * 2.0 / math.pi * (kernel @ (weight * density))))


def slipping(power: float) -> float:
    """Share of the force that friction adds where everything slips, over beta and its small coefficient.

    By reciprocity with a flat punch: 4 beta int_0^a f p(s) (a - sqrt(a^2 - s^2)) ds of the force, p the pressure.
    """
    t, weight = _inside()
    angle = 0.5 * math.pi * t
    length = 0.5 * math.pi * (weight @ np.sqrt(1.0 - (np.sin(angle)[:, None] * t) ** 2))  # the elliptic integral E(t)
    if power > FLATTEST:
        return 1.0 - 2.0 / math.pi
    return float(2.0 * (power + 1.0) / math.pi * (weight * t ** (power - 1.0)) @ (0.5 * math.pi - length))


def _inside() -> tuple[Array, Array]:
    """Nodes and weights of the interval from 0 to 1, denser towards 1, where pressures have their edge."""
    x, weight = np.polynomial.legendre.leggauss(NODES)
    u = 0.5 * (x + 1.0)
    return 1.0 - u**2, u * weight
