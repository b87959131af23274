"""A flat end whose edge is rounded off by a parabola."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

from lumped.load_curves.bent import BentCurve
from lumped.schema.keys import Key, Part
from lumped.shapes.base import SIZE, Bent


@dataclass(frozen=True)
class RoundedPunch(Bent):
    """Flat up to `flat_radius` b, then (r - b)^2/(2 R) high, R the `edge_radius`, m. Raises BadInput."""

    flat: Annotated[float, Key(SIZE, "radius of the flat end", name="flat_radius")]
    edge_radius: Annotated[float, Key(SIZE, "radius of curvature of the edge around it")]
    name: ClassVar[str] = "rounded_punch"
    exponent_of_force: ClassVar[float] = 1.0  # that of its start: F = 2 E* b depth

    @property
    def load_curve(self) -> BentCurve:
        """One bend, at b (Ciavarella 1999, doi 10.1093/imamat/63.2.145)."""
        return BentCurve((self.flat,), (1.0 / self.edge_radius,))


MEMBER = Part(RoundedPunch)
