"""The plate that strikes a rigid plane: uniaxial strain, Table 1's second row, unless its sides are free."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from lumped.schema.keys import Choice, Key, Number
from lumped.shapes._block import Block

KEYS: Mapping[str, Key] = {
    "area": Number(1e-18, 1e8, "m2"),
    "thickness": Number(1e-9, 1e4, "m"),
    "sides": Choice(("free", "confined"), required=False),
    "faces": Choice(("sliding", "bonded"), required=False),
}


class Plate(Block):
    """A block by its area, m2, and thickness, m. Raises BadInput for a value out of range."""

    name: ClassVar[str] = "plate"
    keys: ClassVar[Mapping[str, Key]] = KEYS

    def to_dict(self) -> dict[str, Any]:
        """Its part of the striker's table."""
        return {"shape": self.name} | {key: getattr(self, key) for key in KEYS}


def of(area: float, thickness: float, sides: str = "confined", faces: str = "sliding") -> Plate:
    """A plate of `area`, m2, and `thickness`, m."""
    return Plate(area, thickness, sides, faces)
