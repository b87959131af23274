"""A cone that ends in a sphere, as real cones do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from lumped.load_curves.sphere_cone import SphereConeCurve
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
    exponent_of_force: ClassVar[float] = 1.5  # that of its start

    def height(self, r: ArrayLike) -> Array:
        """The sphere's up to b, then on at the slope tan(angle), m."""
        radius, curve = np.abs(np.asarray(r, dtype=float)), self.load_curve
        cone = curve.steepness * np.maximum(radius - curve.tip, 0.0)
        return np.asarray(self._sphere.height(np.minimum(radius, curve.tip)) + cone)

    def slope(self, r: ArrayLike) -> Array:
        """The sphere's up to b, then tan(angle)."""
        return self._sphere.slope(np.minimum(np.abs(np.asarray(r, dtype=float)), self.load_curve.tip))

    @property
    def load_curve(self) -> SphereConeCurve:
        """Briscoe's closed form."""
        return SphereConeCurve(self.radius, self.angle)

    @property
    def _sphere(self) -> Sphere:
        return Sphere(self.radius)


MEMBER = Part(SphereCone)
