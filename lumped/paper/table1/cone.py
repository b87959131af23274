"""Row 6: a rigid cone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi, radians, tan
from typing import ClassVar

from lumped.paper.table1.base import Elastic, TableRow, pressed
from lumped.scene.indenter import Indenter
from lumped.schema.keys import Key, Number
from lumped.shapes import cone
from lumped.targets import half_space

KEYS: Mapping[str, Key] = {"angle": Number(0.01, 80.0, "degrees, between face and undeformed surface")}


@dataclass(frozen=True)
class ConeRow(TableRow):
    """F = 2/(pi tan(theta)) E* depth^2 (Sneddon, doi 10.1016/0020-7225(65)90019-4); `angle` is theta, degrees."""

    angle: float
    number: ClassVar[int] = 6
    name: ClassVar[str] = "cone"
    case: ClassVar[str] = "rigid cone to elastic plane"
    printed: ClassVar[tuple[str, str]] = ("2/(pi tan theta)", "E")
    corrected: ClassVar[tuple[str, str]] = ("2/(pi tan theta)", "E/(1-nu^2)")
    length_name: ClassVar[str] = ""
    alpha: ClassVar[float] = 2.0
    validity: ClassVar[str] = "theta between face and undeformed surface; small angles, where strains are small"
    correction: ClassVar[str] = (
        "E* lacks 1/(1-nu^2): a half-space, whatever is pressed into it, answers with E/(1-nu^2)"
    )
    keys: ClassVar[Mapping[str, Key]] = KEYS

    @property
    def factor(self) -> float:
        """2/(pi tan(theta))."""
        return 2.0 / (pi * tan(radians(self.angle)))

    @property
    def length(self) -> float:
        """A metre: a cone has no length of its own."""
        return 1.0

    def printed_modulus(self, *bodies: Elastic) -> float:
        """E, Pa."""
        return bodies[0].young

    def scene(self, *bodies: Elastic) -> Indenter:
        """On the half-space."""
        return pressed(self.name, cone.of(self.angle), half_space.of(), *bodies)


EXAMPLE = ConeRow(angle=20.0)
