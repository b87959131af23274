"""Khatiwada, Chouw and Butterworth's generic model: F = k depth^alpha + c depth^alpha rate, alpha free.

Eng. Struct. 62-63, 33-41 (2014), in the form of section 2.5 of the source paper: damping proportional to a power of
the depth, for any exponent, and exact for the restitution asked for. It is the law of Hunt and Crossley, its damper
with a constant c = chi k of its own.
The exact relation does not depend on alpha: it is that of Hunt and Crossley with d = c v_0/k. As there, both
exits are one unless something else drives the bodies apart.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from lumped.laws._damping import Family, formulas
from lumped.laws._parameters import Parameters, damped, damping_key
from lumped.laws._power_law import SpringDamped
from lumped.laws.base import LawKind
from lumped.laws.hunt_crossley import damping, restitution
from lumped.scene.scene import Scene
from lumped.solvers.point.bodies import Stage


@dataclass(frozen=True, kw_only=True)
class Khatiwada(SpringDamped):
    """The law with k, N/m^alpha, and c, N s/m^(alpha + 1)."""

    c: float
    name: ClassVar[str] = "khatiwada"

    def factor(self, stage: Stage) -> float:
        """c/k."""
        return self.c / self.k


def of(scene: Scene) -> Khatiwada:
    """The law for a scene. Raises BadInput."""
    given = Parameters(scene, Khatiwada.name)
    numbers = given.spring_damper(FAMILY, "c", lambda d, k: d * k / scene.velocity)
    return Khatiwada(**numbers, **given.common())


FAMILY = Family(restitution, damping, formulas())
MEMBER = LawKind(of, __doc__, damped(FAMILY, damping_key("c", "N s/m^(alpha + 1)")), FAMILY)
