"""Mahmoud's modified Kelvin model: F = k depth + c rate while approaching, the spring alone in the rebound.

c = 2 xi sqrt(k m). The force jumps to c v at touch, and ends with the depth: both exits are one. Mahmoud and
Jankowski 2011, Iran. J. Sci. Technol. C 35, 51-62.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from lumped.laws._damping import oscillator
from lumped.laws._parameters import LINEAR_STIFFNESS, NO_KEYS, Parameters, damped, damping_key
from lumped.laws._power_law import OscillatorDamped
from lumped.laws.base import LawKind
from lumped.scene.scene import Scene


@dataclass(frozen=True, kw_only=True)
class Mahmoud(OscillatorDamped):
    """The law with stiffness k, N/m, and dashpot c, N s/m."""

    alpha: float = 1.0
    name: ClassVar[str] = "mahmoud"
    rebounds: ClassVar[bool] = False


def of(scene: Scene) -> Mahmoud:
    """The law for a scene. Raises BadInput."""
    given = Parameters(scene, Mahmoud.name)
    return Mahmoud(**given.linear(FAMILY), **given.common())


def mahmoud_jankowski(e: float) -> float:
    """(1-e^2)/(e (e (pi-2) + 2)): Mahmoud and Jankowski 2011, Iran. J. Sci. Technol. C 35, 51-62."""
    return (1.0 - e) * (1.0 + e) / (e * (e * (math.pi - 2.0) + 2.0))


FAMILY = oscillator(1.0, rebounds=False, mahmoud_jankowski=mahmoud_jankowski)
KEYS = damped(FAMILY, damping_key("xi"), damping_key("c", "N s/m"), stiffness=LINEAR_STIFFNESS, exponent=NO_KEYS)
MEMBER = LawKind(of, __doc__, KEYS, FAMILY)
