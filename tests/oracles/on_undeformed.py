"""A striker met where the points of a surface were before they moved, as small displacements have it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.solids.contact import Overlap
from lumped.shapes.base import Shape


@dataclass(frozen=True)
class OnUndeformed:
    """A ``profile`` in units of ``unit``, along the undeformed normal."""

    profile: Shape
    unit: float

    def overlap(self, place: Array, displacement: Array, depth: float) -> Overlap:
        """See :class:`fe_contact.solids.contact.Obstacle`."""
        within = depth + place[1] + displacement[1] - self.profile.height(self.unit * np.abs(place[0])) / self.unit
        none = np.zeros_like(within)
        return Overlap(within, np.stack([none, np.ones_like(within)]), np.zeros((2, 2, *within.shape)))

    def along(self, place: Array) -> Array:
        """From the axis."""
        return np.asarray(place[0])
