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
        curve = self.load_curve
        return np.asarray(curve.slope * np.abs(r) + 0.5 * np.square(self._beyond(r)) @ np.array(curve.bends))

    def slope(self, r: ArrayLike) -> Array:
        """s + sum c_k (r - t_k)_+."""
        return np.asarray(self.load_curve.slope + self._beyond(r) @ np.array(self.load_curve.bends))

    def _beyond(self, r: ArrayLike) -> Array:
        """(r - t_k)_+, m, the bends last."""
        radius = np.abs(np.asarray(r, dtype=float))
        return np.asarray(np.maximum(radius[..., None] - np.array(self.load_curve.radii), 0.0))
