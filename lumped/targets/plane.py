"""The rigid plane, struck by a block or a sphere that has the material."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault
from lumped.keys import Key
from lumped.load_curves.base import LoadCurve
from lumped.materials import Material
from lumped.radiation import Pulse
from lumped.shapes._block import Block
from lumped.shapes._round import Round
from lumped.shapes.base import Shape
from lumped.targets.base import Target

KEYS: Mapping[str, Key] = {}


@dataclass(frozen=True)
class Plane(Target):
    """A plane that does not yield."""

    name: ClassVar[str] = "plane"
    keys: ClassVar[Mapping[str, Key]] = KEYS
    has_inertia: ClassVar[bool] = True
    deformable: ClassVar[bool] = False
    yielding_strikers: ClassVar[bool] = True

    def overlap(self, shape: Shape, r: ArrayLike, depth: ArrayLike) -> NDArray[np.float64]:
        """depth - height(r)."""
        return np.asarray(np.asarray(depth, dtype=float) - shape.height(r))

    def pressed_height(self, shape: Shape) -> float | None:
        """A block's, m."""
        return shape.thickness if isinstance(shape, Block) else None

    def inertia_left_out(self, shape: Shape, material: Material, pulse: Pulse) -> tuple[float | None, str]:
        """A ball's own vibrations: v/c in order of magnitude, as what is left of them (Rayleigh 1906).

        They answer the kinks with which a force t^(3/2) begins and ends: (time of a wave / contact time)^5 ~ v/c.
        """
        whole = None if material.density is None else shape.whole_mass(material.density)
        stiffness = material.young.relaxed or material.young.glassy
        if whole is None or material.density is None or not stiffness:
            return super().inertia_left_out(shape, material, pulse)
        share = math.sqrt(2.0 * pulse.energy / whole) / math.sqrt(stiffness / material.density)
        return min(share, 1.0), "order of magnitude: v/c, of the ball's own vibrations; model.inertia"

    def check_striker(self, source: str, shape: Shape) -> None:
        """Raise BadInput for a striker that is neither a block nor a sphere."""
        if not isinstance(shape, Block | Round):
            reason = f"{shape.name}: a rigid plane is struck by what has a material; accepted: prism, plate, sphere"
            raise BadInput(Fault(source, "striker.shape", reason))

    def load_curve(self, shape: Shape, nu: float) -> LoadCurve:
        """A block's own, per unit of its modulus; raises BadInput where its strain is not uniform, and for a sphere."""
        return shape.load_curve if isinstance(shape, Block) else super().load_curve(shape, nu)

    def check_depth(self, shape: Shape, depth: float) -> str:
        """Not through a block, nor deeper than a sphere is round."""
        if not isinstance(shape, Block):
            return super().check_depth(shape, depth)
        return f"accepted below the block's {shape.thickness:g} m" if depth >= shape.thickness else ""


def of() -> Plane:
    """The plane."""
    return Plane()
