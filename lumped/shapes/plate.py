"""The plate that strikes a rigid plane: uniaxial strain, Table 1's second row, unless its sides are free."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

from lumped.schema.keys import Part
from lumped.shapes._block import SIDES, Block


@dataclass(frozen=True)
class Plate(Block):
    """A block by its area, m2, and thickness, m. Raises BadInput for a value out of range."""

    sides: Annotated[str, SIDES] = "confined"
    name: ClassVar[str] = "plate"


MEMBER = Part(Plate)
