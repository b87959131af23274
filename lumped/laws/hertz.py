"""The nonlinear elastic model, "(4)": F = k depth^(3/2), nothing is lost; of a scene, Hertz's impact.

Of a scene k = (4/3) E* sqrt(R) with the relaxed modulus, the profile a parabola.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from lumped.laws._parameters import COMMON, EXPONENT, STIFFNESS, Parameters
from lumped.laws._power_law import Undamped
from lumped.laws.base import LawKind
from lumped.scene.scene import Scene


@dataclass(frozen=True, kw_only=True)
class HertzLaw(Undamped):
    """The law with its stiffness k, N/m^alpha."""

    alpha: float = 1.5
    name: ClassVar[str] = "hertz"


def of(scene: Scene) -> HertzLaw:
    """The law for a scene. Raises BadInput, for a fluid too, which has no relaxed modulus."""
    given = Parameters(scene, HertzLaw.name)
    alpha = given.exponent()
    return HertzLaw(k=given.stiffness(alpha), alpha=alpha, **given.common())


MEMBER = LawKind(of, __doc__, (STIFFNESS, EXPONENT, COMMON))
