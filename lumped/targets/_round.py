"""What the round targets share: struck by their like, both bodies deformable."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import Fault
from lumped.materials import Material
from lumped.materials.radiation import Pulse
from lumped.numbers import Array
from lumped.schema.keys import Choice, Key
from lumped.shapes.base import SIZE, Shape
from lumped.targets._strains import Pressed
from lumped.targets.base import MOVES, LeftOut, Target, vibrations

SUPPORTS = ("free", "held")
SUPPORT = Key(Choice(SUPPORTS), "what balances the struck body")


@dataclass(frozen=True)
class RoundTarget(Target):
    """A body of this radius, m; places are distances from the line of motion, m.

    `strikers` are its like, exact and a parabola.

    `support`: "free", the body balanced by its own uniform acceleration; "held", rigid from its middle plane on;
    None, it is taken as a half-space. Depth is the approach of the centres of mass. Raises BadInput.
    """

    radius: Annotated[float, Key(SIZE, "radius of the struck body")]
    support: Annotated[str | None, SUPPORT]

    @property
    @abstractmethod
    def outline(self) -> Shape:
        """Its own profile."""

    def overlap(self, shape: Shape, r: ArrayLike, depth: ArrayLike) -> Array:
        """depth - height(r) of both profiles; where the striker's is a parabola, the target's is one too."""
        return np.asarray(np.asarray(depth, dtype=float) - shape.height(r) - self.matching(shape).height(r))

    def round_radius(self, shape: Shape) -> float:
        """The smaller of both."""
        return min(self.radius, super().round_radius(shape))

    def pressed(self, shape: Shape, nu: float, depth: float, contact_radius: float) -> Pressed:
        """Each by half of the depth, down to its middle, along a contact that stays flat."""
        known = super().pressed(shape, nu, depth, contact_radius)
        return replace(known, depth=0.5 * depth, thickness=self.radius, base="sliding", moving=False)

    def inertia_left_out(self, shape: Shape, material: Material, pulse: Pulse) -> LeftOut:
        """A half-space's where it is taken as one; of a free body what :func:`vibrations` leave.

        Held at its middle plane, a third of its half moves with the striker.
        """
        whole = None if material.density is None else self.whole_mass(material.density)
        if self.support is None or whole is None:
            return super().inertia_left_out(shape, material, pulse)
        if self.support == "free":
            return vibrations(material, pulse)
        added = whole / 6.0 / pulse.mass
        return LeftOut(min(added, 1.0), MOVES.format(added))

    def left_out_of_both(self, shape: Shape, material: Material, striking: Material, pulse: Pulse) -> LeftOut:
        """Two half-spaces' where it is taken as one; else the larger of its own and the striker's vibrations."""
        if self.support is None:
            return super().left_out_of_both(shape, material, striking, pulse)
        own = self.inertia_left_out(shape, material, pulse)
        if own.size is None or striking.density is None:
            return own if own.size is None else LeftOut(None, "needs striker.material.density")
        other = vibrations(striking, pulse)
        return own if other.size is not None and other.size <= own.size else other

    def yielding_faults(self, source: str, shape: Shape, inertia: bool) -> list[Fault]:
        """Nothing: it is struck by its like."""
        return []

    def waves_under(self, shape: Shape) -> bool:
        """Only where it flies."""
        return super().waves_under(shape) and self.support == "free"

    def steady_waves(self, shape: Shape) -> bool:
        """As those of the ball that strikes it."""
        return True

    def matching(self, shape: Shape) -> Shape:
        """Its own profile, exact or a parabola as the striker's."""
        return self.outline.resolved("exact" if shape.name == self.strikers[0] else "parabola")

    def check_depth(self, shape: Shape, depth: float) -> str:
        """Not deeper than the smaller body is round."""
        radius = min(self.radius, shape.tip_radius or self.radius)
        return f"accepted below the smaller radius {radius:g} m" if depth >= radius else ""
