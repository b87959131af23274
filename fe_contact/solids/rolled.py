"""A ring laid flat: where its points are, and how the slopes of what is known on the flat mesh turn with it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array


@dataclass(frozen=True)
class Rolled:
    """From (x, z), x the arc on the circle of ``radius``, z = radius - distance from its middle, to the plane.

    The middle is at (0, radius), the lowest point of the circle at the origin.
    """

    radius: float

    def place(self, flat: Array) -> Array:
        """Of points (2, ...)."""
        angle, distance = flat[0] / self.radius, self.radius - flat[1]
        return np.stack([distance * np.sin(angle), self.radius - distance * np.cos(angle)])

    def place_on(self, arc: Array) -> Array:
        """Of points of the circle itself."""
        return self.place(np.stack([arc, np.zeros_like(arc)]))

    def stretch(self, flat: Array) -> Array:
        """Length along the circle over that on the mesh, (...)."""
        return np.asarray(1.0 - flat[1] / self.radius)

    def slopes(self, gradient: Array, flat: Array) -> Array:
        """In the plane, (2, ..., n), of n functions' slopes on the mesh at points (2, ...)."""
        angle, along = (flat[0] / self.radius)[..., None], gradient[0] / self.stretch(flat)[..., None]
        sine, cosine = np.sin(angle), np.cos(angle)
        return np.stack([cosine * along - sine * gradient[1], sine * along + cosine * gradient[1]])
