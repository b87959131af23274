"""The cone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lumped.load_curves.cone import ConeCurve
from lumped.numbers import Array
from lumped.schema.keys import Key, Number, Part
from lumped.shapes.base import Shape


@dataclass(frozen=True)
class Cone(Shape):
    """A cone whose face stands at `angle`, degrees, to the undeformed surface: Table 1's theta. Raises BadInput."""

    angle: Annotated[
        float, Key(Number(0.01, 80.0, "degrees, between face and undeformed surface"), "how steep the face is")
    ]
    name: ClassVar[str] = "cone"
    exponent_of_force: ClassVar[float] = 2.0

    def height(self, r: ArrayLike) -> Array:
        """r tan(angle)."""
        return np.asarray(self.load_curve.steepness * np.abs(np.asarray(r, dtype=float)))

    def slope(self, r: ArrayLike) -> Array:
        """tan(angle)."""
        return np.full(np.shape(r), self.load_curve.steepness)

    @property
    def load_curve(self) -> ConeCurve:
        """Sneddon's closed form, F = (2/pi) E* depth^2/tan(angle)."""
        return ConeCurve(self.angle)


MEMBER = Part(Cone)
