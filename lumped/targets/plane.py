"""The rigid plane, struck by a block or a sphere that has the material."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import ClassVar

from lumped.errors import BadInput, Fault
from lumped.load_curves.base import LoadCurve
from lumped.materials import Material
from lumped.materials.radiation import Pulse
from lumped.schema.keys import Part
from lumped.shapes._block import Block
from lumped.shapes.base import Shape
from lumped.shapes.sphere import RoundShape
from lumped.targets._strains import StrainField, alike
from lumped.targets.base import LeftOut, Target, vibrations


@dataclass(frozen=True)
class Plane(Target):
    """A plane that does not yield."""

    name: ClassVar[str] = "plane"
    has_inertia: ClassVar[bool] = True
    deformable: ClassVar[bool] = False
    large_strains: ClassVar[bool] = True
    through: ClassVar[str] = "the block's"

    def pressed_height(self, shape: Shape) -> float | None:
        """A block's, m."""
        return shape.thickness if isinstance(shape, Block) else None

    def strains(self, shape: Shape, nu: float, depth: float, contact_radius: float) -> StrainField:
        """A block's, alike everywhere; a ball's down to its middle, along a contact that stays flat."""
        if isinstance(shape, Block):
            return alike(nu, depth / shape.thickness, shape.sides == "free")
        known = replace(self.pressed(shape, nu, depth, contact_radius), moving=False)
        return replace(known, thickness=shape.tip_radius or math.inf, base="sliding").strains()

    def inertia_left_out(self, shape: Shape, material: Material, pulse: Pulse) -> LeftOut:
        """What a ball's :func:`vibrations` leave; a block's own waves add their density c v to its pressure.

        That is v sqrt(E A M/l), M its own mass, beside v sqrt(E A m/l) of the striker's m; a heavy one meets the plane
        with three times as much at least, with the echo of what is on its far face (Saint-Venant).
        """
        if material.density is None:
            return LeftOut(None, self.needs_density)
        if shape.whole_mass(material.density) is not None:
            return vibrations(material, pulse)
        own = shape.own_mass(material.density) / pulse.mass
        met = math.sqrt(own)
        return LeftOut(max(met, 3.0 * met - 1.0), f"waves of a block that has {own:.2g} of the striker's mass")

    def mises(self, shape: Shape, nu: float, force: float, contact_radius: float) -> float:
        """A block's is its pressure, less (1 - 2 nu)/(1 - nu) of it where its sides are held."""
        if not isinstance(shape, Block):
            return super().mises(shape, nu, force, contact_radius)
        return force / shape.area * (1.0 if shape.sides == "free" else (1.0 - 2.0 * nu) / (1.0 - nu))

    def sides(self, shape: Shape) -> str:
        """A block's."""
        return shape.sides if isinstance(shape, Block) else ""

    def met_flat(self, shape: Shape) -> tuple[float, bool]:
        """Nothing more: a block tells its own."""
        return 0.0, False

    def waves_under(self, shape: Shape) -> bool:
        """A block's too that is strained alike everywhere."""
        return not isinstance(shape, Block) or shape.uniform

    def rings_on(self, shape: Shape) -> bool:
        """A ball's own; a block is followed from contact to contact."""
        return not isinstance(shape, Block)

    def steady_waves(self, shape: Shape) -> bool:
        """A ball's, not a block's."""
        return not isinstance(shape, Block)

    def strained_instead(self, shape: Shape) -> str:
        """A block, or what is rigid on a half-space."""
        return "" if isinstance(shape, Block) else f"a prism or a plate; or a rigid {shape.name} on a half_space"

    def check_striker(self, source: str, shape: Shape) -> None:
        """Raise BadInput for a striker that is neither a block nor a sphere."""
        if not isinstance(shape, Block | RoundShape):
            reason = f"{shape.name}: a rigid plane is struck by what has a material; accepted: prism, plate, sphere"
            raise BadInput(Fault(source, "striker.shape", reason))

    def load_curve(self, shape: Shape, nu: float) -> LoadCurve:
        """A block's own, per unit of its modulus; raises BadInput where its strain is not uniform, and for a sphere."""
        return shape.load_curve if isinstance(shape, Block) else super().load_curve(shape, nu)


MEMBER = Part(Plane)
