"""The prism that strikes a rigid plane: uniaxial stress, Table 1's first row, unless its faces are bonded."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from lumped.schema.keys import Choice, Key, Number
from lumped.shapes._block import Block

KEYS: Mapping[str, Key] = {
    "area": Number(1e-18, 1e8, "m2"),
    "height": Number(1e-9, 1e4, "m"),
    "sides": Choice(("free", "confined"), required=False),
    "faces": Choice(("sliding", "bonded"), required=False),
}


class Prism(Block):
    """A block by its area, m2, and height, m. Raises BadInput for a value out of range."""

    name: ClassVar[str] = "prism"
    keys: ClassVar[Mapping[str, Key]] = KEYS

    def to_dict(self) -> dict[str, Any]:
        """Its part of the striker's table."""
        own = {"area": self.area, "height": self.thickness, "sides": self.sides, "faces": self.faces}
        return {"shape": self.name} | own


def of(area: float, height: float, sides: str = "free", faces: str = "sliding") -> Prism:
    """A prism of `area`, m2, and `height`, m."""
    return Prism(area, height, sides, faces)
