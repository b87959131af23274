"""What profiles share whose slope is linear piece by piece."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np
from numpy.typing import ArrayLike

from lumped.load_curves.bent import BentCurve
from lumped.numbers import Array
from lumped.shapes.base import Mixed


class Bent(Mixed):
    """h'(r) = s + sum c_k (r - t_k)_+, as its load curve has them."""

    @property
    @abstractmethod
    def load_curve(self) -> BentCurve:
        """The closed form of its bends."""

    @property
    def flat_radius(self) -> float:
        """That of its load curve, m."""
        return self.load_curve.least_radius

    def height(self, r: ArrayLike) -> Array:
        """s r + sum c_k (r - t_k)_+^2/2, m."""
        radius, curve = np.abs(np.asarray(r, dtype=float)), self.load_curve
        beyond = np.maximum(radius[..., None] - np.array(curve.radii), 0.0)
        return np.asarray(curve.slope * radius + 0.5 * np.square(beyond) @ np.array(curve.bends))

    def slope(self, r: ArrayLike) -> Array:
        """s + sum c_k (r - t_k)_+."""
        radius, curve = np.abs(np.asarray(r, dtype=float)), self.load_curve
        return np.asarray(
            curve.slope + np.maximum(radius[..., None] - np.array(curve.radii), 0.0) @ np.array(curve.bends)
        )
