"""Jankowski's nonlinear viscoelastic model, "(8)" to "(10)": damped while approaching, elastic in the rebound.

F = k depth^alpha + 2 xi sqrt(m k depth^(alpha - 1)) rate, the damper in the approach only; alpha = 3/2 in the
paper. Doi 10.1002/eqe.434.

At alpha = 3/2 and in x = (4/5) depth^(5/4) the approach is a linear oscillator, v dv/dx = -2 xi v - (5/4) x in units
of k and m, of damping ratio zeta = 2 xi/sqrt(5). The force ends with the depth: both exits are one.
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


@dataclass(frozen=True, kw_only=True)
class Jankowski(OscillatorDamped):
    """The law with k, N/m^alpha, and the damper's c = 2 xi sqrt(m k), N s/m^((alpha + 1)/2)."""

    name: ClassVar[str] = "jankowski"
    rebounds: ClassVar[bool] = False


def of(scene: Scene) -> Jankowski:
    """The law for a scene. Raises BadInput."""
    given = Parameters(scene, Jankowski.name)
    return Jankowski(**given.oscillator(FAMILY, "xi", unit=2.0), **given.common())


def equation_10(e: float) -> float:
    """sqrt(5) (1-e^2)/(2 pi e), "(10)"."""
    return SQRT5 / math.tau * (1.0 - e) * (1.0 + e) / e


def jankowski_2006(e: float) -> float:
    """(9 sqrt(5)/2) (1-e^2)/(e (e (9 pi - 16) + 16)), doi 10.1002/eqe.537."""
    return 4.5 * SQRT5 * (1.0 - e) * (1.0 + e) / (e * (e * (9.0 * math.pi - 16.0) + 16.0))


FAMILY = oscillator(0.5 * SQRT5, rebounds=False, equation_10=equation_10, jankowski_2006=jankowski_2006)
MEMBER = LawKind(of, __doc__, damped(FAMILY, damping_key("xi"), exponent=EXPONENT_FROM_ONE), FAMILY)
