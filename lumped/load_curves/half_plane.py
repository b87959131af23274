"""A rigid cylinder on the elastic half-plane: depth has a meaning only against a point some way below."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf, log, pi

import numpy as np

from lumped.errors import BadInput, Fault
from lumped.load_curves.line_curve import LineCurve
from lumped.load_curves.line_profile import LineProfile
from lumped.load_curves.plane_contact import Grown, collocation, folded, grown
from lumped.load_curves.tabulated import FIRST_OF_EXTENT, GROWTH, SHARE_OF_EXTENT

POINTS = 24


@dataclass(frozen=True)
class HalfPlane(LineCurve):
    """Depth is the approach of the cylinder to the material point `datum_depth` (m) below first touch, per unit length.

    A line load P at x' moves the surface at x, against that point, by (2 P/(pi E*)) [ln(r/|x-x'|) - d^2/(2(1-nu) r^2)]
    with r^2 = d^2 + x'^2 (Flamant 1892). Half-widths up to the datum's depth and to 0.85 of a true cylinder's radius.
    `nu` in (-1, 0.5]. Raises BadInput.
    """

    profile: LineProfile
    datum_depth: float
    nu: float

    def __post_init__(self) -> None:
        check_datum(self.datum_depth, self.nu)

    @property
    def curvature_radius(self) -> float:
        """That of the cylinder, m."""
        return self.profile.radius

    @property
    def length(self) -> float:
        """The datum's depth, m."""
        return self.datum_depth

    @cached_property
    def edges(self) -> tuple[float, ...]:
        """Panels up to the datum's depth, as long as the profile lasts."""
        reach = min(self.datum_depth, SHARE_OF_EXTENT * self.profile.extent)
        first = min(FIRST_OF_EXTENT * self.datum_depth, FIRST_OF_EXTENT * self.profile.extent)
        growths = int(np.ceil(np.log(reach / first) / np.log(GROWTH)))
        return (0.0, *(float(edge) for edge in np.geomspace(first, reach, growths + 1)))

    def grown(self, half_width: float, refinement: float) -> Grown:
        """The contact at one half-width."""
        rule = collocation(int(refinement * POINTS))
        x = half_width / self.datum_depth * rule.nodes
        far = 1.0 + x**2
        datum = 0.5 * np.log(far) - 0.5 / ((1.0 - self.nu) * far) - log(half_width / self.datum_depth)
        matrix = 2.0 * half_width / pi * (folded(rule.logarithm) + 2.0 * rule.weight * datum)
        return grown(rule, half_width, matrix, self.profile.height(half_width * rule.nodes))


def check_datum(datum_depth: float, nu: float) -> None:
    """Raises BadInput for a datum that is no depth, or a Poisson's ratio out of range."""
    faults = []
    if not 0.0 < datum_depth < inf:
        message = (
            f"must be above 0 m, is {datum_depth}: in plane strain the half-plane has no finite compliance without it"
        )
        faults.append(Fault("half_space", "datum_depth", message))
    if not -1.0 < nu <= 0.5:
        faults.append(Fault("half_space", "nu", f"must lie above -1 and not above 0.5, is {nu}"))
    if faults:
        raise BadInput(faults)
