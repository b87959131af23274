"""A rigid cylinder on the elastic half-plane: depth has a meaning only against a point some way below.

The exact curve, and two closed forms: Johnson's logarithm, for a point far below, and Popov's row, which needs none.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import e, exp, inf, log, pi
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault, NotReached
from lumped.load_curves.base import LoadCurve, elastic_faults
from lumped.load_curves.plane_contact import LineCurve
from lumped.load_curves.tabulated import Array
from lumped.numbers import Real

POINTS = 24


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
        check_datum(self.datum_depth, self.nu)

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


@dataclass(frozen=True)
class Johnson(LoadCurve):
    """Johnson's logarithm for the parabola x^2/(2R), the datum far below the contact: b << d.

    depth = (F/(pi E*)) [2 ln(2d/b) - nu/(1-nu)], F = pi E* b^2/(4R): the greatest
    depth has 2 ln(2d/b) = 1 + nu/(1-nu).
    `radius` R and `datum_depth` d in m, `nu` in (-1, 0.5]. Raises BadInput; NotReached where no half-width answers.
    Johnson 1985, ISBN 978-0-521-34796-9, chapter 5.
    """

    radius: float
    datum_depth: float
    nu: float

    def __post_init__(self) -> None:
        check_datum(self.datum_depth, self.nu)

    @property
    def extent(self) -> float:
        """The half-width of the greatest depth, m."""
        return 2.0 * self.datum_depth * exp(-0.5 * (1.0 + self._side))

    @property
    def _side(self) -> float:
        return self.nu / (1.0 - self.nu)

    def force(self, depth: ArrayLike) -> Real:
        """F/E* per unit length, m."""
        return self.force_at(self.contact_radius(depth))

    def force_at(self, contact_radius: ArrayLike) -> Real:
        """pi b^2/(4R), m."""
        return 0.25 * pi * np.asarray(contact_radius) ** 2 / self.radius

    def contact_radius(self, depth: ArrayLike) -> Real:
        """Half-width b, m: b^2 ln(b^2/B) = -4 R depth, B = 4 d^2 exp(-nu/(1-nu)), by Lambert's lower branch."""
        from scipy.special import lambertw

        square = 4.0 * self.datum_depth**2 * exp(-self._side)
        depth = np.asarray(depth, dtype=float)
        share = 4.0 * self.radius * np.maximum(depth, 0.0) / square
        if np.max(share, initial=0.0) > 1.0 / e:
            raise NotReached(
                f"no contact on the half-plane is {np.max(depth):g} m deep: its half-width nears the datum's depth"
            )
        answer = np.real(lambertw(-np.where(share > 0.0, share, 0.1), -1))
        return np.where(share > 0.0, np.sqrt(square * np.exp(answer)), 0.0)

    def depth(self, contact_radius: ArrayLike) -> Real:
        """(b^2/(4R)) [2 ln(2d/b) - nu/(1-nu)], m."""
        b = np.asarray(contact_radius, dtype=float)
        return 0.25 * b**2 / self.radius * (self._logarithm(b) - self._side)

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """(b/(2R)) [2 ln(2d/b) - 1 - nu/(1-nu)]."""
        b = np.asarray(contact_radius, dtype=float)
        return 0.5 * b / self.radius * (self._logarithm(b) - 1.0 - self._side)

    def dforce_ddepth(self, depth: ArrayLike) -> Real:
        """pi/[2 ln(2d/b) - 1 - nu/(1-nu)]: a flat punch's, as far as the datum is far."""
        b = np.asarray(self.contact_radius(depth))
        return np.where(b > 0.0, pi / (self._logarithm(b) - 1.0 - self._side), 0.0)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> NDArray[np.float64]:
        """sqrt(b^2-x^2)/(2R)."""
        return hertz_pressure(radius, contact_radius, self.radius)

    def _logarithm(self, b: NDArray[np.float64]) -> NDArray[np.float64]:
        """2 ln(2d/b), 0 without contact."""
        return 2.0 * np.log(2.0 * self.datum_depth / np.where(b > 0.0, b, 2.0 * self.datum_depth))


@dataclass(frozen=True)
class Popov(LoadCurve):
    """The row F = (pi/4) E* l depth of the paper's Table 1, here per unit length, with b^2 = R depth: a heuristic.

    It takes the approach of a sphere for that of a cylinder, which has none; no body follows it at more than one depth.
    `radius` R in m. Popov 2010, ISBN 978-3-642-10802-0, chapter 5.
    """

    radius: float

    def force(self, depth: ArrayLike) -> Real:
        """(pi/4) depth, m."""
        return 0.25 * pi * np.maximum(depth, 0.0)

    def contact_radius(self, depth: ArrayLike) -> Real:
        """sqrt(R depth), m."""
        return np.sqrt(self.radius * np.maximum(depth, 0.0))

    def depth(self, contact_radius: ArrayLike) -> Real:
        """b^2/R, m."""
        return np.asarray(contact_radius) ** 2 / self.radius

    def depth_slope(self, contact_radius: ArrayLike) -> Real:
        """2 b/R."""
        return 2.0 * np.asarray(contact_radius) / self.radius

    def dforce_ddepth(self, depth: ArrayLike) -> Real:
        """pi/4."""
        return np.where(np.asarray(depth) >= 0.0, 0.25 * pi, 0.0)

    def pressure(self, radius: ArrayLike, contact_radius: float) -> NDArray[np.float64]:
        """sqrt(b^2-x^2)/(2R)."""
        return hertz_pressure(radius, contact_radius, self.radius)


def check_datum(datum_depth: float, nu: float) -> None:
    """Raises BadInput for a datum that is no depth, or a Poisson's ratio out of range."""
    faults = []
    if not 0.0 < datum_depth < inf:
        message = (
            f"must be above 0 m, is {datum_depth}: in plane strain the half-plane has no finite compliance without it"
        )
        faults.append(Fault("half_space", "datum_depth", message))
    faults += elastic_faults("half_space", nu)
    if faults:
        raise BadInput(faults)


def hertz_pressure(x: ArrayLike, half_width: float, radius: float) -> NDArray[np.float64]:
    """Hertz's pressure per E* under a parabola x^2/(2R) on the half-plane: sqrt(b^2-x^2)/(2R), zero outside."""
    return np.asarray(np.sqrt(np.maximum(half_width**2 - np.asarray(x, dtype=float) ** 2, 0.0)) / (2.0 * radius))
