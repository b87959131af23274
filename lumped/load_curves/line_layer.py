"""A rigid cylinder on an elastic layer in plane strain, per unit length."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.load_curves.layer import Array, PointLayer, deficit, waves
from lumped.load_curves.line_curve import LineCurve
from lumped.load_curves.line_profile import LineProfile
from lumped.load_curves.plane_contact import Grown, collocation, folded, grown
from lumped.load_curves.tabulated import growing_edges


@dataclass(frozen=True)
class LineLayer(LineCurve):
    """u(x) = (2/(pi E*)) int p(x') int_0^inf L(u) cos(u(x-x')/h)/u du dx': half-widths up to 20 thicknesses and to
    0.85 of a true cylinder's radius; a depth of a thickness or more raises BadInput. Relative accuracy 1e-8, or
    NotReached. Johnson 1985, ISBN 978-0-521-34796-9, chapter 5.
    """

    profile: LineProfile
    layer: PointLayer

    @property
    def curvature_radius(self) -> float:
        """That of the cylinder, m."""
        return self.profile.radius

    @property
    def length(self) -> float:
        """The thickness, m."""
        return self.layer.thickness

    @cached_property
    def edges(self) -> tuple[float, ...]:
        """Panels grow with the distance from the middle."""
        return growing_edges(self.layer.thickness, self.profile.extent)

    def grown(self, half_width: float, refinement: float) -> Grown:
        """The contact at one half-width."""
        ratio = half_width / self.layer.thickness
        rule = collocation(int(refinement * (20.0 + 4.0 * ratio)))
        smooth = self._smooth(ratio * rule.nodes, ratio, refinement) - np.log(ratio)
        matrix = 2.0 * half_width / np.pi * (folded(rule.logarithm) + 2.0 * rule.weight * smooth)
        return grown(rule, half_width, matrix, self.profile.height(half_width * rule.nodes))

    def contact_radius(self, depth: ArrayLike) -> NDArray[np.float64]:
        """Half-width at a depth below the thickness, m; raises BadInput for deeper ones."""
        self.layer.check_depth(depth)
        return np.asarray(super().contact_radius(depth))

    def _smooth(self, x: Array, ratio: float, refinement: float) -> Array:
        """The kernel less -ln|x-x'|, even part, at places in thicknesses: shape (n, n).

        -ln|x| = int_0^inf (cos(ux) - exp(-2u))/u du - ln 2.
        """
        u, weights = waves(ratio, refinement)
        cosines = np.cos(np.outer(x, u))
        density = weights / u
        held = cosines * (density * deficit(self.layer.nu, self.layer.base, u)) @ cosines.T
        return np.asarray(density @ np.exp(-2.0 * u) - held + np.log(2.0))
