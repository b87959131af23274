"""A rigid cylinder on the elastic half-plane: depth has a meaning only against a point some way below."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, log
from typing import ClassVar

import numpy as np

from lumped.errors import BadInput, Fault
from lumped.load_curves.base import elastic_faults
from lumped.load_curves.plane_contact import LineCurve
from lumped.numbers import Array

POINTS = 24  # work: collocation points over the half-width: the kernel is smooth, as many do for all widths


@dataclass(frozen=True)
class HalfPlane(LineCurve):
    """Depth is the approach of the cylinder to the material point `datum_depth` (m) below first touch, per unit length.

    A line load P at x' moves the surface at x, against that point, by (2 P/(pi E*)) [ln(r/|x-x'|) - d^2/(2(1-nu) r^2)]
    with r^2 = d^2 + x'^2 (Flamant 1892). Half-widths up to the datum's depth and to 0.85 of a true cylinder's radius.
    `nu` in (-1, 0.5]. Raises BadInput.
    """

    datum_depth: float
    nu: float
    reach: ClassVar[float] = 1.0

    def __post_init__(self) -> None:
        faults = elastic_faults("half_space", self.nu)
        if not 0.0 < self.datum_depth < inf:
            reason = "in plane strain the half-plane has no finite compliance without it"
            message = f"must be above 0 m, is {self.datum_depth}: {reason}"
            faults.insert(0, Fault("half_space", "datum_depth", message))
        if faults:
            raise BadInput(faults)

    @property
    def length(self) -> float:
        """The datum's depth, m."""
        return self.datum_depth

    def points(self, half_width: float) -> float:
        """As many for all."""
        return POINTS

    def smooth(self, y: Array, half_width: float, refinement: float) -> Array:
        """What the datum moves by, (n,)."""
        far = 1.0 + (half_width / self.datum_depth * y) ** 2
        return 0.5 * np.log(far) - 0.5 / ((1.0 - self.nu) * far) - log(half_width / self.datum_depth)
