"""A deformable cylinder, struck by a parallel one: plane strain, totals over the striker's length."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from lumped.schema.keys import Choice, Key, Number
from lumped.shapes.cylinder import Cylinder as Profile
from lumped.targets._round import SUPPORTS, RoundTarget

KEYS: Mapping[str, Key] = {"radius": Number(1e-9, 1e4, "m"), "support": Choice(SUPPORTS)}


class CylinderTarget(RoundTarget):
    """A cylinder of this radius, m: finite, since in plane strain two half-spaces have no finite approach."""

    name: ClassVar[str] = "cylinder"
    keys: ClassVar[Mapping[str, Key]] = KEYS
    strikers: ClassVar[tuple[str, str]] = ("cylinder", "parabolic_cylinder")

    @property
    def outline(self) -> Profile:
        """Its own profile, of unit length."""
        return Profile(self.radius, 1.0)


def of(radius: float, support: str) -> CylinderTarget:
    """A cylinder of `radius`, m."""
    return CylinderTarget(radius, support)
