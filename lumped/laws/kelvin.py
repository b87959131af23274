"""Kelvin's linear spring and dashpot, "(5)" to "(7)": F = k depth + c rate, c = 2 xi sqrt(k m), m the reduced mass.

The force jumps to c v at touch. With `exit = "force"` contact ends when it returns to zero; Anagnostopoulos'
damping "(7)" (1988, doi 10.1002/eqe.4290160312) belongs to `exit = "depth"`, where the dashpot may pull. From critical
damping, xi = 1, on the depth never returns to zero.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from lumped.laws._damping import oscillator
from lumped.laws._parameters import LINEAR_STIFFNESS, NO_KEYS, Parameters, damped, damping_key
from lumped.laws._power_law import OscillatorDamped
from lumped.laws.base import LawKind
from lumped.scene.scene import Scene


@dataclass(frozen=True, kw_only=True)
class Kelvin(OscillatorDamped):
    """The law with stiffness k, N/m, and dashpot c, N s/m."""

    alpha: float = 1.0
    name: ClassVar[str] = "kelvin"
    rebounds: ClassVar[bool] = True


def of(scene: Scene) -> Kelvin:
    """The law for a scene. Raises BadInput."""
    given = Parameters(scene, Kelvin.name)
    return Kelvin(**given.linear(FAMILY), **given.common())


def anagnostopoulos(e: float) -> float:
    """-ln e/sqrt(pi^2 + ln^2 e), "(7)", doi 10.1002/eqe.4290160311: exact where the depth ends."""
    return FAMILY.damping(e, "depth")


FAMILY = oscillator(1.0, rebounds=True, anagnostopoulos=anagnostopoulos)
KEYS = damped(FAMILY, damping_key("xi"), damping_key("c", "N s/m"), stiffness=LINEAR_STIFFNESS, exponent=NO_KEYS)
MEMBER = LawKind(of, __doc__, KEYS, FAMILY)
