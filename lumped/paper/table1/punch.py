"""Row 3: a flat-ended rigid cylinder."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from lumped.paper.table1.base import Elastic, TableRow, pressed
from lumped.scene.indenter import Indenter
from lumped.schema.keys import Key, Number
from lumped.shapes import punch
from lumped.targets import half_space

KEYS: Mapping[str, Key] = {"radius": Number(1e-9, 1e4, "m")}


@dataclass(frozen=True)
class PunchRow(TableRow):
    """F = 2 R E* depth (Boussinesq 1885)."""

    radius: float
    number: ClassVar[int] = 3
    name: ClassVar[str] = "punch"
    case: ClassVar[str] = "rigid cylinder to elastic plane"
    printed: ClassVar[tuple[str, str]] = ("2R", "E/(1-nu^2)")
    corrected: ClassVar[tuple[str, str]] = printed
    length_name: ClassVar[str] = "radius"
    alpha: ClassVar[float] = 1.0
    validity: ClassVar[str] = "a flat end on a half-space: any depth of small strains"
    keys: ClassVar[Mapping[str, Key]] = KEYS

    @property
    def factor(self) -> float:
        """2 R, m."""
        return 2.0 * self.radius

    @property
    def length(self) -> float:
        """The radius, m."""
        return self.radius

    def scene(self, *bodies: Elastic) -> Indenter:
        """On the half-space."""
        return pressed(self.name, punch.of(self.radius), half_space.of(), *bodies)


EXAMPLE = PunchRow(radius=0.01)
