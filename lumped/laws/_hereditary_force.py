"""The correspondence law as a force between two masses that remembers: any exit, any number of contacts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from lumped.laws._force_law import ForceLaw
from lumped.scene.scene import Scene
from lumped.scene.tables import Model
from lumped.solvers.point import memory
from lumped.solvers.point.bodies import TINY, Bodies, Stage, State, Step
from lumped.solvers.point.hereditary import HereditaryLoad, StepLoad
from lumped.solvers.point.nodes import through_zero
from lumped.solvers.point.step import NODES

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class HereditaryForce(ForceLaw):
    """F = int E*(t-s) dy, "(17)" to "(19)"; `rule` says what is remembered between contacts, `scale` is a time, s."""

    load: HereditaryLoad
    rule: str
    scale: float
    within_step: StepLoad | None = None
    name: ClassVar[str] = "correspondence"
    tensile: ClassVar[bool] = True
    remembers: ClassVar[bool] = True

    @property
    def parameters(self) -> dict[str, Any]:
        """Its choices; the rest is the scene's."""
        return {"exit": self.exit, "memory": self.rule}

    def touch(self, bodies: Bodies) -> State:
        """A relaxed surface."""
        return State(0.0, bodies.velocity, 0.0, self.load.at_rest)

    def within(self, start: State, length: float) -> HereditaryForce:
        """Its branches solved for at the points of the step."""
        return replace(self, within_step=StepLoad.of(self.load, start.memory, length, NODES))

    def remembered(self, depth: Array) -> tuple[float, ...]:
        """The memories at the end of the step."""
        return tuple(self._step.memories(depth)[:, -1].tolist())

    def force(self, depth: Any, rate: Any, stage: Stage) -> Any:
        """F at the points of the step, N."""
        return self._step.force(depth, rate)

    def tangents(self, depth: Any, rate: Any, stage: Stage) -> tuple[Any, Any]:
        """Slopes at the points of the step."""
        return self._step.tangents(depth, rate)

    def carried(self, depth: float, stage: Stage) -> float:
        """Not known: it creeps."""
        return math.nan

    def lost(self, depth: Any, rate: Any, stage: Stage) -> Any:
        """All of it: what a memory of the load gives back is no potential of the depth."""
        return self._step.force(depth, rate)

    def stored(self, depth: float, stage: Stage) -> float:
        """Nothing is counted as stored."""
        return 0.0

    def time_scale(self, bodies: Bodies) -> float:
        """The scene's elastic contact time."""
        return self.scale

    def between(
        self, steps: Sequence[Step], place: NDArray[np.intp], share: Array, depth: Array, rate: Array, stage: Stage
    ) -> Array:
        """F from the memories, polynomials through their values at the points and at the start of each step."""
        force = np.zeros_like(depth)
        for index in np.unique(place):
            here, step = place == index, steps[index]
            there = StepLoad.of(self.load, step.start.memory, step.length, NODES)
            values = np.column_stack([there.memory, there.memories(np.maximum(step.depth, TINY))])
            force[here] = self.load.force(depth[here], rate[here], values @ through_zero(share[here]).T)
        return force

    def returned(self, bodies: Bodies, last: State) -> tuple[float, State] | None:
        """As the rule has it."""
        again: tuple[float, State] | None = memory.get(self.rule).returned(self.load, bodies, last)
        return again

    def resolved(self, scene: Scene) -> Model:
        """The scene's own profile."""
        return scene.model

    @property
    def _step(self) -> StepLoad:
        assert self.within_step is not None
        return self.within_step


def law_of(scene: Scene, exit: str = "force", rule: str = "recovering") -> HereditaryForce:
    """The law for a scene, on the load curve of its target. Raises BadInput where no load curve is known."""
    curve = scene.load_curve
    load = HereditaryLoad(curve, scene.contact_modulus.scaled(scene.geometry.shape.total))
    return HereditaryForce(exit=exit, rule=rule, load=load, scale=scene.elastic_contact_time, load_curve=curve)
