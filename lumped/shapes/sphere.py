"""The sphere, and the paraboloid which stands for it when `model.profile = "parabola"`: a tip of one radius."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, ClassVar

from lumped.load_curves.hertz import Hertz, HertzImpact, hertz_impact
from lumped.load_curves.sneddon_sphere import SneddonSphere
from lumped.schema.keys import Key, Part
from lumped.shapes.base import SIZE, Circular, Parabolic, Round, Shape


@dataclass(frozen=True)
class RoundShape(Round):
    """A profile with this radius at its tip, m. Raises BadInput for a radius out of range."""

    radius: Annotated[float, Key(SIZE, "radius of the sphere")]
    exponent_of_force: ClassVar[float] = 1.5

    def hertz_impact(self, modulus: float, mass: float, velocity: float) -> HertzImpact:
        """Scales of the Hertz impact, exact for the paraboloid."""
        return hertz_impact(self.radius, modulus, mass, velocity)


@dataclass(frozen=True)
class Sphere(Circular, RoundShape):
    """A sphere of this radius, m. Raises BadInput for a radius out of range."""

    name: ClassVar[str] = "sphere"

    def whole_mass(self, density: float) -> float:
        """density 4/3 pi R^3, kg."""
        return density * 4.0 / 3.0 * math.pi * self.radius**3

    @property
    def load_curve(self) -> SneddonSphere:
        """Sneddon's closed form."""
        return SneddonSphere(self.radius)

    def resolved(self, profile: str) -> Shape:
        """Itself, or the parabola with the same curvature."""
        return Parabola(self.radius) if profile == "parabola" else self


@dataclass(frozen=True)
class Parabola(Parabolic, RoundShape):
    """h(r) = r^2/(2R), R in m: no shape of a scene file, but what its sphere may resolve to."""

    name: ClassVar[str] = "parabola"

    @property
    def load_curve(self) -> Hertz:
        """Hertz's closed form."""
        return Hertz(self.radius)


MEMBER = Part(Sphere)
