"""The parabolic cylinder which stands for a round one when `model.profile = "parabola"`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.load_curves import line_profile
from lumped.shapes._outlines import parabola, parabola_slope
from lumped.shapes.cylinder import Cylinder


@dataclass(frozen=True)
class ParabolicCylinder(Cylinder):
    """h(r) = r^2/(2R), R in m: no shape of a scene file, but what its cylinder may resolve to."""

    name: ClassVar[str] = "parabolic_cylinder"

    def height(self, r: ArrayLike) -> NDArray[np.float64]:
        """r^2/(2R)."""
        return parabola(r, self.radius)

    def slope(self, r: ArrayLike) -> NDArray[np.float64]:
        """r/R."""
        return parabola_slope(r, self.radius)

    @property
    def line_profile(self) -> line_profile.LineProfile:
        """The parabola."""
        return line_profile.ParabolicCylinder(self.radius)

    def resolved(self, profile: str) -> Cylinder:
        """Itself."""
        return self
