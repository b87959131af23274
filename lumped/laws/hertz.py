"""Hertz's impact: F = (4/3) E* sqrt(R) depth^(3/2), elastic, with the relaxed modulus; nothing is lost."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

from lumped.errors import BadInput, Fault
from lumped.laws._hereditary import simulate
from lumped.laws.correspondence import solve
from lumped.materials import Relaxation
from lumped.result import Result
from lumped.scene import Scene


@dataclass(frozen=True)
class HertzLaw:
    """The law with its contact modulus E*, Pa."""

    modulus: float
    name: ClassVar[str] = "hertz"

    @property
    def message(self) -> str:
        """What the law takes of the scene."""
        return f"Hertz's law: elastic with the relaxed contact modulus {self.modulus:.6g} Pa, profile a parabola"

    def simulate(self, scene: Scene, tolerance: float) -> Result:
        """One impact to this tolerance. Raises NotReached."""
        parabola = scene.shape.resolved("parabola")
        model = replace(scene.model, profile="parabola")
        elastic = Relaxation(self.modulus)
        return simulate(self.name, scene, parabola, elastic, tolerance, solve, model, self.message)


def of(scene: Scene) -> HertzLaw:
    """The law for a scene; raises BadInput for a fluid, which has no relaxed modulus."""
    relaxed = scene.contact_modulus.relaxed
    if relaxed == 0.0:
        reason = "a fluid has no relaxed modulus, which Hertz's law needs; accepted: a solid, or another law"
        raise BadInput(Fault(scene.source, "target.material", reason))
    return HertzLaw(relaxed)
