"""A ring whose outer surface is held, struck from inside by a cylinder."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lumped.errors import BadInput, Fault
from lumped.load_curves.base import LoadCurve
from lumped.load_curves.ring import RodInRing
from lumped.materials import Material
from lumped.materials.radiation import Pulse
from lumped.numbers import Array
from lumped.schema.keys import Key, Part
from lumped.shapes.base import SIZE, Shape
from lumped.targets.base import FreeEnd, LeftOut, Target
from lumped.targets.layer import Layer

# Inner radius over thickness: the waves in the annulus' answer grow with it, and with them the time, to seconds here.
THINNEST = 1000.0


@dataclass(frozen=True)
class Ring(Target):
    """A ring of these dimensions, m; its places are angles from the line of motion, rad. Raises BadInput."""

    inner_radius: Annotated[float, Key(SIZE, "radius of the hole")]
    thickness: Annotated[float, Key(SIZE, "between the hole and what holds the ring")]
    name: ClassVar[str] = "ring"
    large_strains: ClassVar[bool] = True
    through: ClassVar[str] = "the ring's thickness"
    strikers: ClassVar[tuple[str, ...]] = ("cylinder", "parabolic_cylinder")

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.inner_radius > THINNEST * self.thickness:
            reason = f"{self.thickness:g}: accepted from {self.inner_radius / THINNEST:g} m on in a ring as wide"
            raise BadInput(Fault("ring", "thickness", reason))

    @property
    def length_of_place(self) -> float:
        """The inner radius: its places are angles."""
        return self.inner_radius

    @property
    def body_depth(self) -> float:
        """Its thickness, m."""
        return self.thickness

    def overlap(self, shape: Shape, r: ArrayLike, depth: ArrayLike) -> Array:
        """D cos(theta) + sqrt(R^2 - D^2 sin^2(theta)) - inner_radius, D = clearance + depth; `r` is theta."""
        radius, angle = shape.tip_radius or 0.0, np.asarray(r, dtype=float)
        clearance = self.inner_radius - radius
        offset = clearance + np.asarray(depth, dtype=float)
        # sqrt(R^2 - s^2) - R without losing digits, s = D sin(theta); D cos(theta) - clearance likewise
        across = offset * np.sin(angle)
        sagitta = across**2 / (radius + np.sqrt(np.maximum(radius**2 - across**2, 0.0)))
        return np.asarray(np.asarray(depth) - 2.0 * offset * np.sin(0.5 * angle) ** 2 - sagitta)

    def load_curve(self, shape: Shape, nu: float) -> LoadCurve:
        """By the Fourier series of the annulus."""
        return RodInRing(shape.tip_radius or 0.0, self.inner_radius, self.thickness, nu)

    def inertia_left_out(self, shape: Shape, material: Material, pulse: Pulse) -> LeftOut:
        """A layer's, held by the outer surface."""
        return Layer(self.thickness, "bonded").inertia_left_out(shape, material, pulse)

    def ends(self, shape: Shape, nu: float, contact_radius: float) -> FreeEnd:
        """A layer's, held by the outer surface."""
        return Layer(self.thickness, "bonded").ends(shape, nu, contact_radius)

    def check_striker(self, source: str, shape: Shape) -> None:
        """Raise BadInput for a striker that is no cylinder, or does not fit in."""
        super().check_striker(source, shape)
        if (shape.tip_radius or 0.0) >= self.inner_radius:
            reason = f"{shape.tip_radius:g}: accepted below the ring's inner radius {self.inner_radius:g} m"
            raise BadInput(Fault(source, "striker.radius", reason))


MEMBER = Part(Ring)
