"""The contract of a target: what is struck."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.keys import Key
from lumped.shapes.base import Shape


class Target(ABC):
    """The geometry of a struck body; `name` and `keys` are those of the scene file."""

    name: ClassVar[str]
    keys: ClassVar[Mapping[str, Key]]
    has_inertia: ClassVar[bool]

    @abstractmethod
    def overlap(self, shape: Shape, r: ArrayLike, depth: ArrayLike) -> NDArray[np.float64]:
        """Interpenetration of the undeformed surfaces, m, positive inside; broadcasts over r and depth, m."""

    def to_dict(self) -> dict[str, Any]:
        """The geometry's part of the target's table."""
        return {"shape": self.name} | {key: getattr(self, key) for key in self.keys}
