"""A deformable cylinder, struck by a parallel one: plane strain, totals over the striker's length."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

from lumped.schema.keys import Part
from lumped.shapes.cylinder import Cylinder as Profile
from lumped.targets._round import SUPPORT, RoundTarget


@dataclass(frozen=True)
class CylinderTarget(RoundTarget):
    """A cylinder of this radius, m: finite, since in plane strain two half-spaces have no finite approach."""

    support: Annotated[str, SUPPORT]
    name: ClassVar[str] = "cylinder"
    strikers: ClassVar[tuple[str, ...]] = ("cylinder", "parabolic_cylinder")

    @property
    def outline(self) -> Profile:
        """Its own profile, of unit length."""
        return Profile(self.radius, 1.0)


MEMBER = Part(CylinderTarget)
