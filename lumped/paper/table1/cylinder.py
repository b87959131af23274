"""Row 5: a rigid cylinder, its axis along the plane."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import ClassVar

from lumped.paper.table1.base import Elastic, TableRow, pressed
from lumped.scene.indenter import Indenter
from lumped.schema.keys import Key, Number
from lumped.shapes import cylinder
from lumped.targets import layer

LAYER = 10.0  # thickness over radius
KEYS: Mapping[str, Key] = {"radius": Number(1e-9, 1e4, "m"), "height": Number(1e-9, 1e6, "m")}


@dataclass(frozen=True)
class CylinderRow(TableRow):
    """F = (pi/4) l E* depth, a heuristic (Popov 2010, ISBN 978-3-642-10802-0, section 5.2); `height` is l."""

    radius: float
    height: float
    number: ClassVar[int] = 5
    name: ClassVar[str] = "cylinder"
    case: ClassVar[str] = "rigid cylinder to elastic plane (curvature surface contact)"
    printed: ClassVar[tuple[str, str]] = ("pi l/4", "E/(1-nu^2)")
    corrected: ClassVar[tuple[str, str]] = ("none: F/(E* depth) depends on the datum", "E/(1-nu^2)")
    length_name: ClassVar[str] = "radius"
    alpha: ClassVar[float] = 1.0
    validity: ClassVar[str] = "one depth of each layer or datum: where 2 ln(2 datum/b) - nu/(1-nu) = 4"
    correction: ClassVar[str] = (
        "in plane strain the half-plane has no finite compliance: "
        "depth = F/(pi E* l) [2 ln(2 datum/b) - nu/(1-nu)] (Johnson 1985, section 5.6)"
    )
    single: ClassVar[bool] = False
    keys: ClassVar[Mapping[str, Key]] = KEYS

    @property
    def factor(self) -> float:
        """pi l/4, m."""
        return 0.25 * pi * self.height

    @property
    def length(self) -> float:
        """The radius, m."""
        return self.radius

    def scene(self, *bodies: Elastic) -> Indenter:
        """Its parabola on a thick layer, whose thickness stands for the datum."""
        shape, target = cylinder.of(self.radius, self.height), layer.of(LAYER * self.radius, "bonded")
        return pressed(self.name, shape, target, *bodies, profile="parabola")


EXAMPLE = CylinderRow(radius=0.01, height=0.01)
