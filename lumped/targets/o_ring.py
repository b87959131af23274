"""A ring of round section lying flat on a rigid plane, pressed by a coaxial flat end."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import BadInput, Fault
from lumped.materials import Material
from lumped.materials.plasticity import first_yield
from lumped.materials.radiation import Pulse
from lumped.numbers import Array
from lumped.schema.keys import Key, Part
from lumped.shapes.base import SIZE, Shape
from lumped.shapes.sphere import Sphere
from lumped.targets._strains import Pressed
from lumped.targets.base import MOVES, LeftOut, Target


@dataclass(frozen=True)
class ORing(Target):
    """A ring of this mean radius and radius of section, m; places count from the top of the section. Raises BadInput.

    Two contacts alike: the depth is the approach of the two planes, half of it at each.
    """

    mean_radius: Annotated[float, Key(SIZE, "from the axis to the middle of the section")]
    section_radius: Annotated[float, Key(SIZE, "radius of the section")]
    name: ClassVar[str] = "o_ring"
    large_strains: ClassVar[bool] = True
    through: ClassVar[str] = "the ring's thickness"
    strikers: ClassVar[tuple[str, ...]] = ("punch",)
    called: ClassVar[str] = "an O-ring"
    pinched: ClassVar[bool] = True
    lead: ClassVar[float] = 0.5  # the other half is the other contact's

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.section_radius >= self.mean_radius:
            reason = f"{self.section_radius:g}: accepted below the mean radius {self.mean_radius:g} m"
            raise BadInput(Fault("o_ring", "section_radius", reason))

    def overlap(self, shape: Shape, r: ArrayLike, depth: ArrayLike) -> Array:
        """depth/2 - (s - sqrt(s^2 - x^2)), s the section's radius and `r` the distance x from its top."""
        section = Sphere(self.section_radius)
        return np.asarray(self.lead * np.asarray(depth, dtype=float) - section.height(r))

    def pressed_height(self, shape: Shape) -> float:
        """The section's height, m."""
        return 2.0 * self.section_radius

    def pressed(self, shape: Shape, nu: float, depth: float, contact_radius: float) -> Pressed:
        """Half of the section, in plane strain: a layer that slides on the plane of symmetry, under a flat end.

        A contact that small strains make wider than the section is as wide as that.
        """
        known, half = super().pressed(shape, nu, depth, min(contact_radius, self.section_radius)), self.lead * depth
        return replace(known, depth=half, plane=True, thickness=self.section_radius, base="sliding", moving=False)

    def inertia_left_out(self, shape: Shape, material: Material, pulse: Pulse) -> LeftOut:
        """The section's middle moves half as fast as the striker, and its sides out as fast where the volume stays."""
        if material.density is None:
            return LeftOut(None, self.needs_density)
        mass = material.density * 2.0 * math.pi**2 * self.mean_radius * self.section_radius**2
        added = 0.25 * (1.0 + (material.nu / (1.0 - material.nu)) ** 2) * mass / pulse.mass
        return LeftOut(min(added, 1.0), MOVES.format(added))

    def mises(self, shape: Shape, nu: float, force: float, contact_radius: float) -> float:
        """As of a line around it."""
        pressure = force / (math.pi**2 * contact_radius * self.mean_radius)
        return pressure / first_yield(nu, plane=True)

    def met_flat(self, shape: Shape) -> tuple[float, bool]:
        """Nothing: the section is round."""
        return 0.0, False

    def round_radius(self, shape: Shape) -> float:
        """That of the section."""
        return self.section_radius

    def fixed_radius(self, shape: Shape) -> float | None:
        """None: both contacts widen with the depth."""
        return None

    def check_striker(self, source: str, shape: Shape) -> None:
        """Raise BadInput for a striker that is no punch, or does not cover the ring."""
        super().check_striker(source, shape)
        outside = self.mean_radius + self.section_radius
        if (shape.fixed_radius or 0.0) < outside:
            reason = f"{shape.fixed_radius:g}: accepted from the ring's outer radius {outside:g} m on"
            raise BadInput(Fault(source, "striker.radius", reason))


MEMBER = Part(ORing)
