"""A law that is a force between two masses: its march, its bars and its Result, the same for every one."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from lumped.collide.bodies import TINY, Bodies, Stage, State
from lumped.collide.flight import returned
from lumped.collide.motion import Motion, motion
from lumped.collide.outcome import Outcome, outcome_of
from lumped.collide.outcome import peak_of as peak_of
from lumped.collide.phase import Phase
from lumped.collide.step import Step
from lumped.collide.track import Track
from lumped.ending import End
from lumped.laws._assembly import Answer, Clock, assemble, bars, impulse_of
from lumped.load_curves.base import LoadCurve
from lumped.result import Result, meets
from lumped.scene import END_IN_CONTACT_TIMES, Model, Scene

Array = NDArray[np.float64]
# Errors of the rate allowed in one step, relative to the velocity at touch; the end of contact errs far less.
# The first one is that asked of the result, if it is not beyond these; every next one is finer by FINER.
COARSEST, FINEST, FINER = 1e-4, 1e-12, 1e-2
SAFETY = 2.0


@dataclass(frozen=True, kw_only=True)
class ForceLaw(ABC):
    """F(depth, rate) of two masses, contract :class:`lumped.collide.bodies.PointLaw`.

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

    def grading(self, stage: Stage) -> int:
        """One: smooth in time from touch on."""
        return 1

    @abstractmethod
    def force(self, depth: Any, rate: Any, stage: Stage) -> Any:
        """F, N, compression positive; depth >= 0, m, rate, m/s."""

    @abstractmethod
    def tangents(self, depth: Any, rate: Any, stage: Stage) -> tuple[Any, Any]:
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

    @abstractmethod
    def lost(self, depth: Any, rate: Any, stage: Stage) -> Any:
        """The part of the force whose work is not stored, N."""

    @abstractmethod
    def stored(self, depth: float, stage: Stage) -> float:
        """Energy that the law could still give back at a depth, J."""

    @abstractmethod
    def time_scale(self, bodies: Bodies) -> float:
        """The elastic contact time, s."""

    @property
    def parameters(self) -> dict[str, Any]:
        """Its numbers by the names of the scene file."""
        return {f.name: getattr(self, f.name) for f in fields(self) if f.name not in ("load_curve", "source")}

    def elastic_contact_time(self, scene: Scene) -> float:
        """Contact time without damping, s."""
        return self.time_scale(bodies_of(scene))

    def simulate(self, scene: Scene, tolerance: float) -> Result:
        """The impacts of a scene to this tolerance. Raises NotReached."""
        clock, until = Clock(), self._until(scene)
        step_tolerance = min(max(tolerance, FINEST / FINER), COARSEST)
        coarse, steps = self._answer(scene, until, step_tolerance)
        while True:
            step_tolerance *= FINER
            fine, counted = self._answer(scene, until, step_tolerance)
            steps += counted
            quantities, force_error = bars(fine, coarse, SAFETY)
            if meets(quantities, tolerance) or step_tolerance <= FINEST:
                break
            coarse = fine
        numerics = {"integrator": "Radau collocation", "step_tolerance": step_tolerance, "law": self.parameters}
        work, model = {"steps": steps}, self.resolved(scene)
        return assemble(self.name, scene, tolerance, fine, quantities, force_error, clock, numerics, work, model)

    def outcome(self, scene: Scene, tolerance: float = 1e-6) -> Outcome:
        """What a study of many impacts needs of the first contact, by one march and without bars. Raises TooManySteps.

        `tolerance`: relative; the march is as fine as that of a Result which meets it at once.
        """
        step_tolerance = min(max(tolerance, FINEST / FINER), COARSEST) * FINER
        track = Track(self, motion(self, bodies_of(scene), self.exit, 1, self._until(scene), step_tolerance))
        return outcome_of(track, track.motion.contacts[0])

    def resolved(self, scene: Scene) -> Model:
        """The scene's model as this law has it: its stiffness stands for a parabola."""
        return replace(scene.model, profile="parabola") if scene.has_geometry else scene.model

    def _until(self, scene: Scene) -> float:
        return scene.motion.end_time or END_IN_CONTACT_TIMES * self.elastic_contact_time(scene) * scene.motion.impacts

    def _answer(self, scene: Scene, until: float, step_tolerance: float) -> tuple[Answer, int]:
        """One integration, and how many steps it took."""
        moved = motion(self, bodies_of(scene), self.exit, scene.motion.impacts, until, step_tolerance)
        track = Track(self, moved)
        outcomes = tuple(outcome_of(track, one) for one in moved.contacts)
        said = "" if moved.end is End.SEPARATED else moved.end.value
        answer = Answer(
            track.rows,
            lambda times: self._columns(track, times),
            self._values(scene, moved, outcomes),
            moved.end,
            self._energy(scene, moved),
            "; ".join(part for part in (self.source, said) if part),
            until,
            tuple(outcome._asdict() for outcome in outcomes) if scene.motion.impacts > 1 else (),
        )
        return answer, sum(len(phase.steps) for one in moved.contacts for phase in one.phases)

    def _columns(self, track: Track, times: Array) -> Array:
        depth, rate, force = track(times)
        if self.exit == "force":
            force = np.maximum(force, 0.0)
        pressed = np.where(force > 0.0, np.maximum(depth, 0.0), 0.0)
        radius = np.zeros_like(depth) if self.load_curve is None else self.load_curve.contact_radius(pressed)
        return np.array([depth, rate, force, radius])

    def _values(self, scene: Scene, moved: Motion, outcomes: Sequence[Outcome]) -> Mapping[str, float | None]:
        highest = max(outcomes, key=lambda outcome: outcome.peak_force)
        last = moved.contacts[-1]
        return {
            "peak_force": highest.peak_force,
            "peak_time": highest.peak_time,
            "peak_depth": max(outcome.peak_depth for outcome in outcomes),
            "duration": outcomes[0].duration,
            "restitution": outcomes[0].restitution,
            "impulse": impulse_of(scene, moved.end, last.last.rate, last.end_time, self._until(scene)),
        }

    def _energy(self, scene: Scene, moved: Motion) -> dict[str, float | None]:
        """Energies at the end of the last contact, J, each on its own."""
        last, mass = moved.contacts[-1].last, scene.reduced_mass
        given = 0.5 * mass * scene.velocity**2 + mass * scene.gravity * last.depth
        out = 0.5 * mass * last.rate**2
        stored = [self._stored(one.last, one.phases[-1]) for one in moved.contacts]
        found = [self._stored(one.first, one.phases[0]) for one in moved.contacts[1:]]
        # What a contact leaves behind and the next one does not find is lost: the surface recovers in between.
        lost = last.lost + sum(stored[:-1]) - sum(found)
        residual = given - out - stored[-1] - lost
        return {"in": given, "out": out, "stored": stored[-1], self.loss: lost, "residual": residual}

    def _stored(self, state: State, phase: Phase) -> float:
        """What is stored where a phase begins or ends, J."""
        return float(self.stored(max(state.depth, 0.0), phase.stage))


def bodies_of(scene: Scene) -> Bodies:
    """The relative motion of a scene."""
    return Bodies(scene.reduced_mass, scene.velocity, scene.gravity)
