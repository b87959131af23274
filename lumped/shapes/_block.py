"""What prism and plate share: a deformable block of constant cross-section between two rigid planes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

from lumped.errors import BadInput, Fault
from lumped.load_curves.fixed_area import Column
from lumped.load_curves.hertz import HertzImpact, power_impact
from lumped.materials import Material, Relaxation
from lumped.schema.keys import Choice, Key, Number
from lumped.shapes.base import SIZE, FlatEnded

THICKNESS = Key(SIZE, "between the faces, along the motion")
SIDES = Key(Choice(("free", "confined")), "what holds the sides")


@dataclass(frozen=True)
class Block(FlatEnded):
    """A block of this area, m2, and thickness along the motion, m; a cylinder where its outline matters.

    `sides`: "free" or "confined" by a rigid smooth wall; `faces`: "sliding" or "bonded" to what presses them.
    Raises BadInput.
    """

    area: Annotated[float, Key(Number(1e-18, 1e8, "m2"), "area of a face")]
    thickness: Annotated[float, THICKNESS]
    sides: Annotated[str, SIDES]
    faces: Annotated[str, Key(Choice(("sliding", "bonded")), "what holds the faces")] = "sliding"

    @property
    def fixed_radius(self) -> float:
        """Radius of the circle of its area, m."""
        return math.sqrt(self.area / math.pi)

    def own_mass(self, density: float) -> float:
        """density x area x thickness, kg."""
        return density * self.area * self.thickness

    @property
    def uniform(self) -> bool:
        """Whether it is strained alike everywhere: unless both its faces are bonded and its sides free."""
        return self.faces == "sliding" or self.sides == "confined"

    @property
    def load_curve(self) -> Column:
        """F = modulus x area x depth/thickness; raises BadInput where the strain is not uniform."""
        if not self.uniform:
            reason = "bonded: no closed form with free sides; accepted: finite elements, or sliding"
            raise BadInput(Fault(self.name, "striker.faces", reason))
        return self._column

    def modulus(self, material: Material) -> Relaxation:
        """Young's modulus with free sides (uniaxial stress), the confined one else (uniaxial strain), Pa."""
        return material.uniaxial_modulus() if self.sides == "free" else material.confined_modulus()

    def hertz_impact(self, modulus: float, mass: float, velocity: float) -> HertzImpact:
        """Scales of the elastic impact, those of a uniform strain."""
        return power_impact(self._column, self.exponent_of_force, modulus, mass, velocity)

    @property
    def _column(self) -> Column:
        return Column(self.fixed_radius, self.thickness)
