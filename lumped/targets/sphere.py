"""A deformable sphere, struck by a sphere."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

from lumped.errors import Fault
from lumped.load_curves.base import LoadCurve
from lumped.load_curves.half_space import TwoProfiles
from lumped.materials import Material
from lumped.schema.keys import Part
from lumped.shapes import Sphere as Profile
from lumped.shapes.base import Shape
from lumped.targets._round import SUPPORT, RoundTarget


@dataclass(frozen=True)
class SphereTarget(RoundTarget):
    """A sphere of this radius, m: a half-space under the gap of two spheres, finite where its support is said."""

    support: Annotated[str | None, SUPPORT] = None
    name: ClassVar[str] = "sphere"
    has_inertia: ClassVar[bool] = True
    strikers: ClassVar[tuple[str, ...]] = ("sphere", "parabola")

    @property
    def outline(self) -> Profile:
        """Its own profile."""
        return Profile(self.radius)

    @property
    def has_length(self) -> bool:
        """Only where it is finite."""
        return self.support is not None

    def whole_mass(self, density: float) -> float:
        """density 4/3 pi R^3, kg."""
        return self.outline.whole_mass(density)

    def inertia_faults(self, source: str, striker: Material | None) -> list[Fault]:
        """It has to be free, and its striker to be its like."""
        faults = []
        if self.support != "free":
            said = "none" if self.support is None else self.support
            reason = f'{said}: with model.inertia a struck sphere flies; accepted: "free"'
            faults.append(Fault(source, "target.support", reason))
        if striker is None:
            reason = "missing; with model.inertia a sphere is struck by one that has a material and a density too"
            faults.append(Fault(source, "striker.material", reason))
        return faults

    def load_curve(self, shape: Shape, nu: float) -> LoadCurve:
        """Of two half-spaces under the gap of both profiles; raises BadInput for finite bodies."""
        if self.support is not None:
            return super().load_curve(shape, nu)
        return TwoProfiles(shape.load_curve, self.matching(shape).load_curve)


MEMBER = Part(SphereTarget)
