"""A cone that ends in a sphere, as real cones do."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lumped.load_curves.sneddon import SphereConeCurve
from lumped.numbers import Array
from lumped.schema.keys import Key, Number, Part
from lumped.shapes.base import SIZE, Mixed
from lumped.shapes.sphere import Sphere


@dataclass(frozen=True)
class SphereCone(Mixed):
    """A sphere of this radius R, m, up to b = R sin(angle); from there on its tangent cone. Raises BadInput."""

    radius: Annotated[float, Key(SIZE, "radius of the sphere at the tip")]
    angle: Annotated[
        float, Key(Number(1.0, 80.0, "degrees, between face and undeformed surface"), "of the cone's face")
    ]
    name: ClassVar[str] = "sphere_cone"

    def height(self, r: ArrayLike) -> Array:
        """The sphere's up to b, then on at the slope tan(angle), m."""
        radius, tip = np.abs(np.asarray(r, dtype=float)), self.load_curve.tip
        cone = self._steepness * np.maximum(radius - tip, 0.0)
        return np.asarray(self._sphere.height(np.minimum(radius, tip)) + cone)

    def slope(self, r: ArrayLike) -> Array:
        """The sphere's up to b, then tan(angle)."""
        return self._sphere.slope(np.minimum(np.abs(np.asarray(r, dtype=float)), self.load_curve.tip))

    @property
    def exponent_of_force(self) -> float:
        """3/2, that of its start."""
        return 1.5

    @property
    def load_curve(self) -> SphereConeCurve:
        """Briscoe's closed form."""
        return SphereConeCurve(self.radius, self.angle)

    @property
    def _sphere(self) -> Sphere:
        return Sphere(self.radius)

    @property
    def _steepness(self) -> float:
        return math.tan(math.radians(self.angle))


MEMBER = Part(SphereCone)
