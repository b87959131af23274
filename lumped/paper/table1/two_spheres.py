"""Row 7: two elastic spheres."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt
from typing import ClassVar

from lumped.paper.table1.base import Elastic, TableRow, pressed
from lumped.scene.indenter import Indenter
from lumped.schema.keys import Key, Number
from lumped.shapes import sphere
from lumped.targets import sphere as targets

KEYS: Mapping[str, Key] = {"radius": Number(1e-9, 1e4, "m"), "other_radius": Number(1e-9, 1e4, "m")}


@dataclass(frozen=True)
class TwoSpheres(TableRow):
    """F = (4/3) sqrt(R) E* depth^(3/2), 1/R = 1/R_a + 1/R_b (Hertz 1882): two half-spaces under paraboloids."""

    radius: float
    other_radius: float
    number: ClassVar[int] = 7
    name: ClassVar[str] = "two_spheres"
    case: ClassVar[str] = "elastic curvature surface to elastic curvature surface"
    printed: ClassVar[tuple[str, str]] = (
        "(4/3) sqrt(Ra Rb/(Ra+Rb))",
        "1/((1-nu_a^2)/E_a + (1-nu_b^2)/E_b)",
    )
    corrected: ClassVar[tuple[str, str]] = printed
    length_name: ClassVar[str] = "gap's radius"
    alpha: ClassVar[float] = 1.5
    validity: ClassVar[str] = "contacts far smaller than either sphere"
    bodies: ClassVar[int] = 2
    keys: ClassVar[Mapping[str, Key]] = KEYS

    @property
    def factor(self) -> float:
        """(4/3) sqrt(R), m^(1/2)."""
        return 4.0 / 3.0 * sqrt(self.length)

    @property
    def length(self) -> float:
        """R of the gap, m."""
        return self.radius * self.other_radius / (self.radius + self.other_radius)

    def scene(self, *bodies: Elastic) -> Indenter:
        """Two half-spaces under the gap of both spheres."""
        return pressed(self.name, sphere.of(self.radius), targets.of(self.other_radius), *bodies)

    def whole_scene(self, *bodies: Elastic) -> Indenter:
        """Both spheres free; depth is the approach of their centres of mass."""
        return pressed(self.name, sphere.of(self.radius), targets.of(self.other_radius, "free"), *bodies)


EXAMPLE = TwoSpheres(radius=0.01, other_radius=0.02)
