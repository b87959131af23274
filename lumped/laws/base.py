"""The contract of a law: a force between two masses, or what time does to a load curve.

A law is one module of this folder with `KEYS`, those of the `[law]` table, and `of(scene) -> Law`; a Law is a frozen
dataclass which knows its `name` and simulates the impacts of a scene to a tolerance.
"""

from __future__ import annotations

from typing import ClassVar, Protocol

from lumped.result import Result
from lumped.scene import Scene


class Law(Protocol):
    """A force law with everything it took from its scene."""

    name: ClassVar[str]

    def simulate(self, scene: Scene, tolerance: float) -> Result:
        """The impacts of a scene; every claimed error is the integration error of this law. Raises NotReached."""


def simulate(model: Law, scene: Scene, tolerance: float = 1e-6) -> Result:
    """The impacts of a scene under the law `model`, every ruled quantity to `tolerance`.

    Raises NotReached, or BadInput for a scene that the law has no answer for.
    """
    scene.check_mass("a lumped law")
    return model.simulate(scene, tolerance)
