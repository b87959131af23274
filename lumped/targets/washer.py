"""A ring of rectangular section on a rigid foundation, struck coaxially by a flat end."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, ClassVar

from lumped.errors import BadInput, Fault
from lumped.materials import Material
from lumped.materials.radiation import Pulse
from lumped.schema.keys import Key, Part
from lumped.shapes.base import SIZE, Shape
from lumped.targets._strains import StrainField, alike
from lumped.targets.base import MOVES, LeftOut, Target
from lumped.targets.layer import BASE, moving_share


@dataclass(frozen=True)
class Washer(Target):
    """A washer of these dimensions, m, bonded to its foundation or sliding on it, always in touch. Raises BadInput."""

    inner_radius: Annotated[float, Key(SIZE, "radius of the hole")]
    outer_radius: Annotated[float, Key(SIZE, "radius of the rim")]
    height: Annotated[float, Key(SIZE, "thickness of the washer")]
    base: Annotated[str, BASE]
    name: ClassVar[str] = "washer"
    large_strains: ClassVar[bool] = True
    through: ClassVar[str] = "the washer's height"
    strikers: ClassVar[tuple[str, ...]] = ("punch",)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.inner_radius >= self.outer_radius:
            reason = f"{self.inner_radius:g}: accepted below the outer radius {self.outer_radius:g} m"
            raise BadInput(Fault("washer", "inner_radius", reason))

    @property
    def body_depth(self) -> float:
        """Its height, m."""
        return self.height

    def inertia_left_out(self, shape: Shape, material: Material, pulse: Pulse) -> LeftOut:
        """What of the washer moves with the striker, as under a line around it: a strip as wide as what is pressed."""
        if material.density is None:
            return LeftOut(None, self.needs_density)
        radius = self.fixed_radius(shape) or 0.0
        half, around = 0.5 * (radius - self.inner_radius), math.pi * (radius + self.inner_radius)
        share = moving_share(material.nu, self.base, half / self.height, 0.0, plane=True)
        added = share * material.density * 2.0 * half * around * self.height / pulse.mass
        return LeftOut(min(added, 1.0), MOVES.format(added))

    def covered(self, shape: Shape) -> float:
        """Area that is pressed, m2."""
        return math.pi * ((self.fixed_radius(shape) or 0.0) ** 2 - self.inner_radius**2)

    def mises(self, shape: Shape, nu: float, force: float, contact_radius: float) -> float:
        """As of a column with free sides."""
        return force / self.covered(shape)

    def sides(self, shape: Shape) -> str:
        """Free, as :meth:`strains` has them."""
        return "free"

    def met_flat(self, shape: Shape) -> tuple[float, bool]:
        """A column's, of what is covered."""
        return self.covered(shape), True

    def strains(self, shape: Shape, nu: float, depth: float, contact_radius: float) -> StrainField:
        """Alike everywhere, its sides free: a bonded base holds them less than it seems.

        A bonded wall thinner than half of its height leans outwards, softer, which this does not see.
        """
        return alike(nu, depth / self.height, free=True)

    def fixed_radius(self, shape: Shape) -> float | None:
        """Up to the rim of the punch, or to its own."""
        return None if shape.fixed_radius is None else min(shape.fixed_radius, self.outer_radius)

    def strained_instead(self, shape: Shape) -> str:
        """A punch that covers it, whose rim does not cut in."""
        covered = self.fixed_radius(shape) == self.outer_radius
        return "" if covered else f"a striker.radius from {self.outer_radius:g} m on, which covers the washer"

    def check_striker(self, source: str, shape: Shape) -> None:
        """Raise BadInput for a striker that is no punch, or passes through the hole."""
        super().check_striker(source, shape)
        if (shape.fixed_radius or 0.0) <= self.inner_radius:
            reason = f"{shape.fixed_radius:g}: accepted above the washer's inner radius {self.inner_radius:g} m"
            raise BadInput(Fault(source, "striker.radius", reason))


MEMBER = Part(Washer)
