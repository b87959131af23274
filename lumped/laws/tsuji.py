"""Tsuji's model: F = k depth^alpha + c depth^((alpha - 1)/2) rate, c = alpha_t sqrt(m k), in approach and rebound.

Alpha = 3/2 in doi 10.1016/0032-5910(92)88030-L. With `exit = "depth"` the damper pulls at the end.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from lumped.laws._oscillator_damped import OscillatorDamped
from lumped.laws._parameters import COMMON, EXPONENT_FROM_ONE, RESTITUTION, STIFFNESS, damping_key, formula_key
from lumped.laws.base import LawKind
from lumped.scene.scene import Scene


@dataclass(frozen=True, kw_only=True)
class Tsuji(OscillatorDamped):
    """The law with k, N/m^alpha, and the damper's c, N s/m^((alpha + 1)/2)."""

    name: ClassVar[str] = "tsuji"
    tensile: ClassVar[bool] = True
    rebounds: ClassVar[bool] = True


def of(scene: Scene) -> Tsuji:
    """The law for a scene. Raises BadInput."""
    return Tsuji.damped_by(scene, "alpha_t")


MEMBER = LawKind(
    of, __doc__, (STIFFNESS, EXPONENT_FROM_ONE, RESTITUTION, damping_key("alpha_t"), formula_key("tsuji"), COMMON)
)
