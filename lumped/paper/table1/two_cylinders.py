"""Row 8: two elastic cylinders with parallel axes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import ClassVar

from lumped.paper.table1.base import Elastic, TableRow, pressed
from lumped.scene.indenter import Indenter
from lumped.schema.keys import Key, Number
from lumped.shapes import cylinder
from lumped.targets import cylinder as targets

KEYS: Mapping[str, Key] = {
    "radius": Number(1e-9, 1e4, "m"),
    "other_radius": Number(1e-9, 1e4, "m"),
    "height": Number(1e-9, 1e6, "m"),
}


@dataclass(frozen=True)
class TwoCylinders(TableRow):
    """F = (pi/4) l E* depth, a heuristic (Popov 2010, ISBN 978-3-642-10802-0, section 5.2); `height` is l."""

    radius: float
    other_radius: float
    height: float
    number: ClassVar[int] = 8
    name: ClassVar[str] = "two_cylinders"
    case: ClassVar[str] = "elastic cylinder to elastic cylinder (parallel contact)"
    printed: ClassVar[tuple[str, str]] = ("pi l/4", "1/((1-nu_a^2)/E_a + (1-nu_b^2)/E_b)")
    corrected: ClassVar[tuple[str, str]] = (
        "none: F/(E* depth) depends on where each cylinder is held",
        "1/((1-nu_a^2)/E_a + (1-nu_b^2)/E_b)",
    )
    length_name: ClassVar[str] = "gap's radius"
    alpha: ClassVar[float] = 1.0
    validity: ClassVar[str] = "one depth of each way to hold the cylinders"
    correction: ClassVar[str] = (
        "in plane strain no body has a compliance of its own: to the approach each adds F (1-nu^2)/(pi E l) "
        "[2 ln(2 datum/b) - nu/(1-nu)], its datum where it is held (Johnson 1985, section 5.6)"
    )
    single: ClassVar[bool] = False
    bodies: ClassVar[int] = 2
    keys: ClassVar[Mapping[str, Key]] = KEYS

    @property
    def factor(self) -> float:
        """pi l/4, m."""
        return 0.25 * pi * self.height

    @property
    def length(self) -> float:
        """R of the gap, 1/R = 1/R_a + 1/R_b, m."""
        return self.radius * self.other_radius / (self.radius + self.other_radius)

    def scene(self, *bodies: Elastic) -> Indenter:
        """Their parabolas, the struck one held at its middle plane."""
        striker, target = cylinder.of(self.radius, self.height), targets.of(self.other_radius, "held")
        return pressed(self.name, striker, target, *bodies, profile="parabola")


EXAMPLE = TwoCylinders(radius=0.01, other_radius=0.02, height=0.01)
