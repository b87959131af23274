"""The rigid plane, struck by a block that has the material."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault
from lumped.keys import Key
from lumped.load_curves.base import LoadCurve
from lumped.shapes._block import Block
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

    def pressed_height(self, shape: Shape) -> float:
        """The block's, m."""
        assert isinstance(shape, Block)
        return shape.thickness

    def check_striker(self, source: str, shape: Shape) -> None:
        """Raise BadInput for a striker that is no block."""
        if not isinstance(shape, Block):
            reason = f"{shape.name}: a rigid plane is struck by what has a material; accepted: prism, plate"
            raise BadInput(Fault(source, "striker.shape", reason))

    def load_curve(self, shape: Shape, nu: float) -> LoadCurve:
        """The block's own, per unit of its modulus; raises BadInput where its strain is not uniform."""
        return shape.load_curve

    def check_depth(self, shape: Shape, depth: float) -> str:
        """Not through the block."""
        assert isinstance(shape, Block)
        return f"accepted below the block's {shape.thickness:g} m" if depth >= shape.thickness else ""


def of() -> Plane:
    """The plane."""
    return Plane()
