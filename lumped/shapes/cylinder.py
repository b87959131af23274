"""The cylinder whose axis lies parallel to the surface: plane strain, totals over its length."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, ClassVar

from lumped.errors import BadInput, Fault
from lumped.load_curves.base import LoadCurve
from lumped.load_curves.hertz import HertzImpact
from lumped.load_curves.plane_contact import CylinderProfile, LineProfile, ParabolaProfile
from lumped.schema.keys import Key, Number, Part
from lumped.shapes.base import SIZE, Circular, Parabolic


@dataclass(frozen=True)
class Cylinder(Circular):
    """A cylinder of this radius and length, m; r is the distance from the plane through its axis. Raises BadInput."""

    radius: Annotated[float, Key(SIZE, "radius of the cylinder")]
    length: Annotated[float, Key(Number(1e-9, 1e6, "m"), "length along the surface")]
    name: ClassVar[str] = "cylinder"
    plane: ClassVar[bool] = True
    exponent_of_force: ClassVar[float] = 1.0  # as Table 1 has it: F = (pi/4) E* l depth

    @property
    def line_profile(self) -> LineProfile:
        """The true cylinder."""
        return CylinderProfile(self.radius)

    @property
    def total(self) -> float:
        """Its length, m."""
        return self.length

    @property
    def load_curve(self) -> LoadCurve:
        """None: the half-plane has no finite compliance, a layer's depends on its thickness. Raises BadInput."""
        reason = "no load curve of a half-space in plane strain; accepted: layer"
        raise BadInput(Fault("cylinder", "target.shape", reason))

    def resolved(self, profile: str) -> Cylinder:
        """Itself, or the parabola with the same curvature."""
        return ParabolicCylinder(self.radius, self.length) if profile == "parabola" else self

    def hertz_impact(self, modulus: float, mass: float, velocity: float) -> HertzImpact:
        """Scales of the elastic impact, after Popov's F = (pi/4) E* l depth."""
        stiffness = 0.25 * math.pi * modulus * self.length
        period = math.sqrt(mass / stiffness)
        depth = velocity * period
        return HertzImpact(math.pi * period, depth, stiffness * depth, math.sqrt(self.radius * depth))


@dataclass(frozen=True)
class ParabolicCylinder(Parabolic, Cylinder):
    """h(r) = r^2/(2R), R in m: no shape of a scene file, but what its cylinder is if `model.profile = "parabola"`."""

    name: ClassVar[str] = "parabolic_cylinder"

    @property
    def line_profile(self) -> LineProfile:
        """The parabola."""
        return ParabolaProfile(self.radius)


MEMBER = Part(Cylinder)
