"""What every law that is a force between two masses is."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from lumped import laws
from lumped.errors import BadInput, Fault
from lumped.laws import _impacts
from lumped.load_curves.base import LoadCurve
from lumped.numbers import Real
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.scene.tables import Model
from lumped.solvers.point.bodies import TINY, Bodies, Stage, State, Step
from lumped.solvers.point.flight import returned
from lumped.solvers.point.outcome import Outcome

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class ForceLaw(ABC):
    """F(depth, rate) of two masses, contract :class:`lumped.solvers.point.bodies.PointLaw`.

    `exit`: contact ends when the force returns to zero ("force", no tension) or at depth zero ("depth").
    `gap`: distance before touch, m; time starts at touch. `load_curve`: that of the scene the law was
    made for, whose contact radius the history shows; None: without geometry it shows zero. `source`: in words,
    what was taken of the scene.
    """

    exit: str = "force"
    gap: float = 0.0
    load_curve: LoadCurve | None = None
    source: str = ""
    name: ClassVar[str]
    tensile: ClassVar[bool] = False
    # Where the loss belongs among the energies of a Result.
    loss: ClassVar[str] = "viscous"
    # Whether the force depends on the path, not only on where it turned.
    remembers: ClassVar[bool] = False

    def grading(self, stage: Stage) -> int:
        """One: smooth in time from touch on."""
        return 1

    @abstractmethod
    def force(self, depth: Real, rate: Real, stage: Stage) -> Real:
        """F, N, compression positive; depth >= 0, m, rate, m/s."""

    @abstractmethod
    def tangents(self, depth: Real, rate: Real, stage: Stage) -> tuple[Real, Real]:
        """dF/d depth, N/m, and dF/d rate, N s/m."""

    def touch(self, bodies: Bodies) -> State:
        """At the surface, nothing lost yet."""
        return State(0.0, bodies.velocity, 0.0)

    def within(self, start: State, length: float) -> ForceLaw:
        """Itself: nothing is remembered."""
        return self

    def remembered(self, depth: Array) -> tuple[float, ...]:
        """Nothing."""
        return ()

    def corners(self, stage: Stage) -> tuple[float, ...]:
        """None."""
        return ()

    def kept(self, depth: float, stage: Stage) -> tuple[float, ...]:
        """Nothing."""
        return ()

    def between(
        self, steps: Sequence[Step], place: NDArray[np.intp], share: Array, depth: Array, rate: Array, stage: Stage
    ) -> Array:
        """F at depths and rates, N: where in the steps does not matter without memory."""
        return np.asarray(self.force(np.maximum(depth, TINY), rate, stage))

    def returned(self, bodies: Bodies, last: State) -> tuple[float, State] | None:
        """Free flight to the surface as it was."""
        return returned(self, bodies, last)

    def carried(self, depth: float, stage: Stage) -> float:
        """F without a rate, N."""
        return float(self.force(depth, 0.0, stage))

    @abstractmethod
    def lost(self, depth: Real, rate: Real, stage: Stage) -> Real:
        """The part of the force whose work is not stored, N."""

    @abstractmethod
    def stored(self, depth: float, stage: Stage) -> float:
        """Energy that the law could still give back at a depth, J."""

    @abstractmethod
    def time_scale(self, bodies: Bodies) -> float:
        """The elastic contact time, s."""

    @property
    def parameters(self) -> dict[str, object]:
        """Its numbers by the names of the scene file."""
        return {f.name: getattr(self, f.name) for f in fields(self) if f.name not in ("load_curve", "source")}

    def elastic_contact_time(self, scene: Scene) -> float:
        """Contact time without damping, s."""
        return self.time_scale(_impacts.bodies_of(scene))

    def simulate(self, scene: Scene, tolerance: float) -> Result:
        """The impacts of a scene to this tolerance. Raises TooManySteps."""
        return _impacts.simulate(self, scene, tolerance)

    def outcome(self, scene: Scene, tolerance: float = 1e-6) -> Outcome:
        """What a study of many impacts needs of the first contact, by one march and without bars. Raises TooManySteps.

        `tolerance`: relative; the march is as fine as that of a Result which meets it at once.
        """
        return _impacts.outcome(self, scene, tolerance)

    def resolved(self, scene: Scene) -> Model:
        """The scene's model as this law has it: its stiffness stands for a parabola, and no body for waves."""
        return replace(scene.model, profile="parabola", inertia=False) if scene.has_geometry else scene.model


def between_masses(name: str, scene: Scene) -> ForceLaw:
    """The law called so, made for a scene. Raises BadInput, also where it is no force between two masses."""
    law = laws.get(name).of(scene)
    if not isinstance(law, ForceLaw):
        raise BadInput(Fault(scene.source, "law.name", f"{name} is no force between two masses; accepted: one that is"))
    return law
