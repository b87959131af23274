"""The contract of a law: a force between two masses, or what time does to a load curve.

A law is one module of this folder with `KEYS`, those of the `[law]` table, and `of(scene) -> Law`; a Law is a frozen
dataclass which knows its `name` and simulates the impacts of a scene to a tolerance.
"""

from __future__ import annotations

from typing import ClassVar, Protocol

from lumped.errors import BadInput, Fault
from lumped.result.result import Result
from lumped.scene.scene import Scene


class Law(Protocol):
    """A force law with everything it took from its scene."""

    name: ClassVar[str]

    def simulate(self, scene: Scene, tolerance: float) -> Result:
        """The impacts of a scene; every claimed error is the integration error of this law. Raises NotReached."""


def simulate(model: Law, scene: Scene, tolerance: float = 1e-6) -> Result:
    """The impacts of a scene under the law `model`, every ruled quantity to `tolerance`.

    Raises NotReached, or BadInput for a scene that the law has no answer for. A study of many impacts needs a function
    of its own, and a pool::

        def restitution(speed: float) -> float | None:
            scene = Scene.load("steel-ball-sls", {"striker.velocity": speed})
            return simulate(laws.correspondence.of(scene), scene, 1e-3).quantities["restitution"].value

        with concurrent.futures.ProcessPoolExecutor() as pool:
            found = list(pool.map(restitution, numpy.linspace(0.1, 2.0, 10_000), chunksize=100))
    """
    check_mass(scene)
    with scene.addressed():
        return model.simulate(scene, tolerance)


def check_mass(scene: Scene) -> None:
    """Raise BadInput for a striker without a rigid mass."""
    if scene.mass == 0.0:
        reason = "0: a lumped law moves a rigid mass; accepted: more, or --method fe"
        raise BadInput(Fault(scene.source, "striker.mass", reason))
