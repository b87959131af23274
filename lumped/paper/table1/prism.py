"""Row 1: a prism pressed onto a rigid plane."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from lumped.paper.table1.base import Elastic, TableRow, pressed
from lumped.scene.indenter import Indenter
from lumped.schema.keys import Key, Number
from lumped.shapes import prism
from lumped.targets import plane

KEYS: Mapping[str, Key] = {"area": Number(1e-18, 1e8, "m2"), "height": Number(1e-9, 1e4, "m")}


@dataclass(frozen=True)
class PrismRow(TableRow):
    """F = (A/l) E depth: uniaxial stress."""

    area: float
    height: float
    number: ClassVar[int] = 1
    name: ClassVar[str] = "prism"
    case: ClassVar[str] = "polyhedral cylinder to rigid plane"
    printed: ClassVar[tuple[str, str]] = ("A/l", "E")
    corrected: ClassVar[tuple[str, str]] = printed
    length_name: ClassVar[str] = "height"
    alpha: ClassVar[float] = 1.0
    validity: ClassVar[str] = "free sides, ends that slide: any nu, any slenderness"
    block: ClassVar[bool] = True
    keys: ClassVar[Mapping[str, Key]] = KEYS

    @property
    def factor(self) -> float:
        """A/l, m."""
        return self.area / self.height

    @property
    def length(self) -> float:
        """The height, m."""
        return self.height

    def modulus(self, *bodies: Elastic) -> float:
        """E, Pa."""
        return bodies[0].young

    def scene(self, *bodies: Elastic) -> Indenter:
        """Free sides, faces that slide."""
        return pressed(self.name, prism.of(self.area, self.height, "free", "sliding"), plane.of(), *bodies)


EXAMPLE = PrismRow(area=1e-4, height=0.02)
