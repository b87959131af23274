"""The flat-ended rigid cylinder."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

from lumped.load_curves.fixed_area import PunchCurve
from lumped.schema.keys import Key, Part
from lumped.shapes.base import SIZE, FlatEnded


@dataclass(frozen=True)
class Punch(FlatEnded):
    """A flat end of this radius, m. Raises BadInput for a radius out of range."""

    radius: Annotated[float, Key(SIZE, "radius of the flat end")]
    name: ClassVar[str] = "punch"

    @property
    def fixed_radius(self) -> float:
        """Its own, m."""
        return self.radius

    @property
    def load_curve(self) -> PunchCurve:
        """Boussinesq's closed form."""
        return PunchCurve(self.radius)


MEMBER = Part(Punch)
