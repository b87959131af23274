"""Row 2: a thin plate pressed onto a rigid plane."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from lumped.materials import Material, Relaxation
from lumped.paper.table1.base import Elastic, TableRow, pressed
from lumped.scene.indenter import Indenter
from lumped.schema.keys import Key, Number
from lumped.shapes import plate
from lumped.targets import plane

KEYS: Mapping[str, Key] = {"area": Number(1e-18, 1e8, "m2"), "thickness": Number(1e-9, 1e4, "m")}


@dataclass(frozen=True)
class PlateRow(TableRow):
    """F = (A/l) M depth with the confined modulus M = K + 4 G/3: uniaxial strain."""

    area: float
    thickness: float
    number: ClassVar[int] = 2
    name: ClassVar[str] = "plate"
    case: ClassVar[str] = "thin plate to rigid plane"
    printed: ClassVar[tuple[str, str]] = ("A/l", "E(1-nu)/((1+nu)(1-2nu))")
    corrected: ClassVar[tuple[str, str]] = printed
    length_name: ClassVar[str] = "thickness"
    alpha: ClassVar[float] = 1.0
    validity: ClassVar[str] = "confined sides, or bonded faces far wider than l; nu < 0.5"
    block: ClassVar[bool] = True
    keys: ClassVar[Mapping[str, Key]] = KEYS

    @property
    def factor(self) -> float:
        """A/l, m."""
        return self.area / self.thickness

    @property
    def length(self) -> float:
        """The thickness, m."""
        return self.thickness

    def modulus(self, *bodies: Elastic) -> float:
        """The confined modulus, Pa. Raises BadInput where it is infinite."""
        (young, nu), *_ = bodies
        return Material(Relaxation(young), nu).confined_modulus().relaxed

    def scene(self, *bodies: Elastic) -> Indenter:
        """Confined sides."""
        return pressed(self.name, plate.of(self.area, self.thickness), plane.of(), *bodies)


EXAMPLE = PlateRow(area=1e-2, thickness=1e-3)
