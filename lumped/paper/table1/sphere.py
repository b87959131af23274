"""Row 4: a rigid sphere."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt
from typing import ClassVar

from lumped.paper.table1.base import Elastic, TableRow, pressed
from lumped.scene.indenter import Indenter
from lumped.schema.keys import Key, Number
from lumped.shapes import sphere
from lumped.targets import half_space

KEYS: Mapping[str, Key] = {"radius": Number(1e-9, 1e4, "m")}


@dataclass(frozen=True)
class SphereRow(TableRow):
    """F = (4/3) sqrt(R) E* depth^(3/2) (Hertz 1882): the paraboloid of the sphere's tip."""

    radius: float
    number: ClassVar[int] = 4
    name: ClassVar[str] = "sphere"
    case: ClassVar[str] = "rigid sphere to elastic plane"
    printed: ClassVar[tuple[str, str]] = ("(4/3) sqrt(R)", "E/(1-nu^2)")
    corrected: ClassVar[tuple[str, str]] = printed
    length_name: ClassVar[str] = "radius"
    alpha: ClassVar[float] = 1.5
    validity: ClassVar[str] = "depths far below R on a half-space: a sphere is steeper than its paraboloid"
    keys: ClassVar[Mapping[str, Key]] = KEYS

    @property
    def factor(self) -> float:
        """(4/3) sqrt(R), m^(1/2)."""
        return 4.0 / 3.0 * sqrt(self.radius)

    @property
    def length(self) -> float:
        """The radius, m."""
        return self.radius

    def scene(self, *bodies: Elastic) -> Indenter:
        """On the half-space."""
        return pressed(self.name, sphere.of(self.radius), half_space.of(), *bodies)


EXAMPLE = SphereRow(radius=0.01)
