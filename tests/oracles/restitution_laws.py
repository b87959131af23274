"""Published laws of bodies that yield without hardening, over V* = V/V_y and w = depth/depth_y, both over those of
first yield; each with how far finite elements of others lie from it.
"""

from __future__ import annotations

import math

from scipy.integrate import quad
from scipy.optimize import brentq


def jackson_green_marghitu(speed: float) -> float:
    """Restitution for 1 < V* < 60: Jackson, Green and Marghitu 2010, doi 10.1007/s11071-009-9591-z."""
    return 1.0 - 0.1 * math.log(speed) * ((speed - 1.0) / 59.0) ** 0.156


def thornton(speed: float) -> float:
    """Pressure cut off at first yield's: too little restitution. Thornton 1997, doi 10.1115/1.2787319."""
    inverse = 1.0 / speed
    first = math.sqrt(6.0 * math.sqrt(3.0) / 5.0) * math.sqrt(1.0 - inverse**2 / 6.0)
    return first * (inverse / (inverse + 2.0 * math.sqrt(1.2 - 0.2 * inverse**2))) ** 0.25


def johnson(speed: float) -> float:
    """Mean pressure 3 Y from the touch on: too much below V* = 100. Johnson, Contact Mechanics (1985), (11.47)."""
    return 2.3 * speed**-0.25


def jackson_green(depth: float) -> float:
    """F/F_Hertz of flattening over w, a/R small, within a tenth: Jackson and Green 2005, doi 10.1115/1.1866166."""
    if depth <= 1.9:
        return 1.0
    elastic = math.exp(-0.25 * depth ** (5.0 / 12.0))
    flowed = 4.0 * 2.84 / 1.613 * (1.0 - math.exp(-(depth ** (5.0 / 9.0)) / 25.0))
    return elastic + flowed / math.sqrt(depth)


def sprung_back(speed: float) -> float:
    """Restitution of what is flattened so and springs back as Hertz has it, from a contact as wide as theirs.

    a^2 = R d (w/1.9)^0.14; the work of a release from F is 3 F^2/(10 E* a).
    """

    def force(depth: float) -> float:
        return float(depth**1.5) * jackson_green(depth)

    deepest = brentq(lambda depth: 2.5 * quad(force, 0.0, depth)[0] - speed**2, 0.5, 1e4)
    width = math.sqrt(deepest * max(deepest / 1.9, 1.0) ** 0.14)
    return force(deepest) / (math.sqrt(width) * speed)


def kogut_etsion(depth: float) -> float:
    """The same for 1 to 110, within a tenth: Kogut and Etsion 2002, doi 10.1115/1.1490373."""
    return (1.03 * depth**1.425 if depth <= 6.0 else 1.40 * depth**1.263) / depth**1.5


def kogut_etsion_pressure(depth: float) -> float:
    """Mean pressure over the yield strength, the same range: theirs too."""
    return 1.19 * depth**0.289 if depth <= 6.0 else 1.61 * depth**0.117
