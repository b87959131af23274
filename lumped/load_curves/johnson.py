"""Johnson's logarithmic approach of a cylinder and a point far below it."""

from __future__ import annotations

from dataclasses import dataclass
from math import e, exp, pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import NotReached
from lumped.load_curves.base import LoadCurve
from lumped.load_curves.half_plane import check_datum
from lumped.load_curves.line_profile import hertz_pressure
from lumped.numbers import Real


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
