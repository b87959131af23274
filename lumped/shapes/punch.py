"""The flat-ended rigid cylinder."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.load_curves import fixed_area
from lumped.load_curves.hertz import HertzImpact, power_impact
from lumped.schema.keys import Key, Number
from lumped.schema.record import Part
from lumped.shapes.base import Shape


@dataclass(frozen=True)
class Punch(Shape):
    """A flat end of this radius, m. Raises BadInput for a radius out of range."""

    radius: Annotated[float, Key(Number(1e-9, 1e4, "m"), "radius of the flat end")]
    name: ClassVar[str] = "punch"

    def height(self, r: ArrayLike) -> NDArray[np.float64]:
        """Zero up to the rim, infinite beyond."""
        return np.where(np.abs(np.asarray(r, dtype=float)) <= self.radius, 0.0, np.inf)

    def slope(self, r: ArrayLike) -> NDArray[np.float64]:
        """Zero up to the rim, infinite beyond."""
        return self.height(r)

    def mdr_profile(self, x: ArrayLike) -> NDArray[np.float64]:
        """Zero up to the rim, infinite beyond."""
        return self.height(x)

    @property
    def exponent_of_force(self) -> float:
        """1."""
        return 1.0

    @property
    def fixed_radius(self) -> float:
        """Its own, m."""
        return self.radius

    @property
    def load_curve(self) -> fixed_area.PunchCurve:
        """Boussinesq's closed form."""
        return fixed_area.PunchCurve(self.radius)

    def resolved(self, profile: str) -> Shape:
        """Itself: it has no other profile."""
        return self

    def hertz_impact(self, modulus: float, mass: float, velocity: float) -> HertzImpact:
        """Scales of the elastic impact, exact."""
        return power_impact(self.load_curve, self.exponent_of_force, modulus, mass, velocity)


MEMBER = Part(Punch)
