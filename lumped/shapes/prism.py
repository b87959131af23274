"""The prism that strikes a rigid plane: uniaxial stress, Table 1's first row, unless its faces are bonded."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, ClassVar

from lumped.schema.keys import Part
from lumped.shapes._block import SIDES, THICKNESS, Block

HEIGHT = replace(THICKNESS, name="height")


@dataclass(frozen=True)
class Prism(Block):
    """A block by its area, m2, and height, m, which is its thickness. Raises BadInput for a value out of range."""

    thickness: Annotated[float, HEIGHT]
    sides: Annotated[str, SIDES] = "free"
    name: ClassVar[str] = "prism"


MEMBER = Part(Prism)
