"""Jankowski's nonlinear viscoelastic model, "(8)" to "(10)": damped while approaching, elastic in the rebound.

F = k depth^alpha + 2 xi sqrt(m k depth^(alpha - 1)) rate, the damper in the approach only; alpha = 3/2 in the
paper. Doi 10.1002/eqe.434.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from lumped.laws._oscillator_damped import OscillatorDamped
from lumped.laws._parameters import COMMON, EXPONENT_FROM_ONE, RESTITUTION, STIFFNESS, damping_key, formula_key
from lumped.laws.base import LawKind
from lumped.scene.scene import Scene


@dataclass(frozen=True, kw_only=True)
class Jankowski(OscillatorDamped):
    """The law with k, N/m^alpha, and the damper's c = 2 xi sqrt(m k), N s/m^((alpha + 1)/2)."""

    name: ClassVar[str] = "jankowski"
    rebounds: ClassVar[bool] = False


def of(scene: Scene) -> Jankowski:
    """The law for a scene. Raises BadInput."""
    return Jankowski.damped_by(scene, "xi", unit=2.0)


MEMBER = LawKind(
    of, __doc__, (STIFFNESS, EXPONENT_FROM_ONE, RESTITUTION, damping_key("xi"), formula_key("jankowski"), COMMON)
)
