"""The infinite half-space."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.keys import Key
from lumped.shapes.base import Shape
from lumped.targets.base import Target

KEYS: Mapping[str, Key] = {}


@dataclass(frozen=True)
class HalfSpace(Target):
    """Everything below a plane; values are those of the infinite body. Its inertia is not available yet."""

    name: ClassVar[str] = "half_space"
    keys: ClassVar[Mapping[str, Key]] = KEYS
    has_inertia: ClassVar[bool] = False

    def overlap(self, shape: Shape, r: ArrayLike, depth: ArrayLike) -> NDArray[np.float64]:
        """depth - height(r)."""
        return np.asarray(np.asarray(depth, dtype=float) - shape.height(r))


def of() -> HalfSpace:
    """The half-space has no dimensions."""
    return HalfSpace()
