"""Tsuji's model: F = k depth^alpha + c depth^((alpha - 1)/2) rate, c = alpha_t sqrt(m k), in approach and rebound.

Alpha = 3/2 in doi 10.1016/0032-5910(92)88030-L. With `exit = "depth"` the damper pulls at the end.

At alpha = 3/2 and in x = (4/5) depth^(5/4) it is a linear oscillator, v dv/dx = -alpha_t v - (5/4) x in units of k and
m, of damping ratio zeta = alpha_t/sqrt(5). The force is -depth^(1/4) v dv/dx: zero force and zero depth of the one are
those of the other, and e is that of the Kelvin law with xi = zeta, at either exit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from lumped.laws._damping import oscillator
from lumped.laws._parameters import EXPONENT_FROM_ONE, Parameters, damped, damping_key
from lumped.laws._power_law import OscillatorDamped
from lumped.laws.base import LawKind
from lumped.scene.scene import Scene

SQRT5 = math.sqrt(5.0)  # physics: the formulas' own root, for Hertz's exponent 3/2
# Physics: the published fit of the damping, by power of e.
POLYNOMIAL = (1.2728, -4.2783, 11.087, -22.348, 27.467, -18.022, 4.8218)


@dataclass(frozen=True, kw_only=True)
class Tsuji(OscillatorDamped):
    """The law with k, N/m^alpha, and the damper's c, N s/m^((alpha + 1)/2)."""

    name: ClassVar[str] = "tsuji"
    rebounds: ClassVar[bool] = True


def of(scene: Scene) -> Tsuji:
    """The law for a scene. Raises BadInput."""
    given = Parameters(scene, Tsuji.name)
    return Tsuji(**given.oscillator(FAMILY, "alpha_t"), **given.common())


def antypov_elliott(e: float) -> float:
    """sqrt(5) |ln e|/sqrt(pi^2 + ln^2 e), doi 10.1209/0295-5075/94/50004: exact where the depth ends."""
    return FAMILY.damping(e, "depth")


def tsuji_polynomial(e: float) -> float:
    """sqrt(2) times the fit of degree 6 to Tsuji's curve, doi 10.1016/j.jcp.2008.10.020.

    The fit counts in the mass of one of two equal spheres; the square root of 2 makes it the reduced mass.
    """
    return math.sqrt(2.0) * sum(coefficient * e**power for power, coefficient in enumerate(POLYNOMIAL))


FAMILY = oscillator(SQRT5, rebounds=True, antypov_elliott=antypov_elliott, tsuji_polynomial=tsuji_polynomial)
MEMBER = LawKind(of, __doc__, damped(FAMILY, damping_key("alpha_t"), exponent=EXPONENT_FROM_ONE), FAMILY)
