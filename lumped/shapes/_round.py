"""What the sphere and its paraboloid share: a tip of one radius of curvature."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from lumped.load_curves.hertz import HertzImpact, hertz_impact
from lumped.schema.key_table import check_fields
from lumped.schema.keys import Key, Number
from lumped.shapes.base import Shape

KEYS: Mapping[str, Key] = {"radius": Number(1e-9, 1e4, "m")}


@dataclass(frozen=True)
class RoundShape(Shape):
    """A profile with this radius at its tip, m. Raises BadInput for a radius out of range."""

    radius: float
    keys: ClassVar[Mapping[str, Key]] = KEYS

    def __post_init__(self) -> None:
        check_fields(self.name, self, KEYS)

    @property
    def exponent_of_force(self) -> float:
        """3/2."""
        return 1.5

    @property
    def tip_radius(self) -> float:
        """Its radius, m."""
        return self.radius

    def hertz_impact(self, modulus: float, mass: float, velocity: float) -> HertzImpact:
        """Scales of the Hertz impact, exact for the paraboloid."""
        return hertz_impact(self.radius, modulus, mass, velocity)
