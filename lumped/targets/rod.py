"""A straight rod struck on its end: one-dimensional waves (St Venant)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar

from lumped.errors import BadInput, Fault
from lumped.materials import Material
from lumped.materials.radiation import Pulse
from lumped.schema.keys import Choice, Key, Number, Part
from lumped.shapes.base import Shape
from lumped.targets._strains import StrainField, alike
from lumped.targets.base import LOST_FORCE, LeftOut, Target

# What comes back of a wave of velocity from the other end.
ECHOES: Mapping[str, float] = {"fixed": -1.0, "free": 1.0, "absorbing": 0.0}
# int F^2 dt/(F_max^2 T) of the Hertz pulse: 0.8 B(8/5, 1/2)/(T v/depth), T v/depth = 2.943275.
HERTZ_SQUARE = 0.8 / 2.943275 * math.gamma(1.6) * math.gamma(0.5) / math.gamma(2.1)


@dataclass(frozen=True)
class Rod(Target):
    """A rod of this section, m2, and length, m; its other end is held, free, or goes on for ever. Raises BadInput.

    A flat end (punch) strikes the whole section: its mass moves with the rod's end. A round one dents it first, as it
    would a half-space of the rod's material, and what it presses with goes down the rod.
    """

    area: Annotated[float, Key(Number(1e-18, 1e6, "m2"), "area of the section")]
    length: Annotated[float, Key(Number(1e-9, 1e6, "m"), "length of the rod")]
    end: Annotated[str, Key(Choice(tuple(ECHOES)), "what becomes of waves at the other end")]
    name: ClassVar[str] = "rod"
    has_inertia: ClassVar[bool] = True
    only_with_inertia: ClassVar[bool] = True

    @property
    def echo(self) -> float:
        """What comes back of a wave of velocity from the other end: -1, 1, or 0."""
        return ECHOES[self.end]

    def impedance(self, modulus: float, density: float) -> float:
        """Z = A sqrt(E density), N s/m, of an elastic rod; Pa, kg/m3."""
        return self.area * math.sqrt(modulus * density)

    def contact_time(self, local: float, material: Material, mass: float) -> float:
        """That of the dent, and of the mass on the rod as a spring or, endless, as a dashpot, s."""
        stiffness, density = material.uniaxial_modulus().spring, material.density
        if not stiffness or density is None:
            return local
        if self.end == "absorbing":
            return local + mass / self.impedance(stiffness, density)
        echo = 2.0 * self.length * math.sqrt(density / stiffness)
        return local + echo + math.pi * math.sqrt(mass * self.length / (stiffness * self.area))

    def inertia_left_out(self, shape: Shape, material: Material, pulse: Pulse) -> LeftOut:
        """What goes down the rod before an echo, int F^2 dt/Z, as a share of the energy; half of it before the peak."""
        stiffness, density = material.uniaxial_modulus().spring, material.density
        if not stiffness or density is None:
            return super().inertia_left_out(shape, material, pulse)
        sent = HERTZ_SQUARE * pulse.force**2 * pulse.duration / self.impedance(stiffness, density)
        share = sent / pulse.energy
        return LeftOut(min(LOST_FORCE * share, 1.0), f"sends {share:.2g} of the kinetic energy down the rod")

    def mises(self, shape: Shape, nu: float, force: float, contact_radius: float) -> float:
        """Under a flat end, which strikes the whole section, its pressure on that."""
        return super().mises(shape, nu, force, contact_radius) if shape.fixed_radius is None else force / self.area

    def sides(self, shape: Shape) -> str:
        """Free, where all of it is strained alike."""
        return "" if shape.fixed_radius is None else "free"

    def strains(self, shape: Shape, nu: float, depth: float, contact_radius: float) -> StrainField:
        """Under a flat end alike all along; else near the dent."""
        if shape.fixed_radius is None:
            return super().strains(shape, nu, depth, contact_radius)
        return alike(nu, depth / self.length, free=True)

    def waves_under(self, shape: Shape) -> bool:
        """Always."""
        return True

    def check_striker(self, source: str, shape: Shape) -> None:
        """Raise BadInput for a striker that is no body of revolution."""
        super().check_striker(source, shape)
        if shape.plane:
            reason = f"{shape.name}: a rod is struck by sphere, cone, power or punch"
            raise BadInput(Fault(source, "striker.shape", reason))


MEMBER = Part(Rod)
