"""A law that is a force between two masses: its march, its bars and its Result, the same for every one."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from lumped.collide.bodies import TINY, Bodies, Stage, State
from lumped.collide.contact import Contact
from lumped.collide.flight import returned
from lumped.collide.motion import Motion, motion
from lumped.collide.step import Step
from lumped.collide.track import Track
from lumped.ending import End
from lumped.laws._assembly import Answer, Clock, assemble, bars
from lumped.load_curves.base import LoadCurve
from lumped.result import Result, meets
from lumped.scene import END_IN_CONTACT_TIMES, Model, Scene

Array = NDArray[np.float64]
# Errors of the rate allowed in one step, relative to the velocity at touch; the end of contact errs far less.
# The first one is that asked of the result, if it is not beyond these; every next one is finer by FINER.
COARSEST, FINEST, FINER = 1e-3, 1e-12, 1e-2
SAFETY = 2.0
# Half the widths of the parabolas through which a peak is found, in that of its surroundings.
CLOSER = (0.5, 0.1, 0.02, 0.004)


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

    @property
    def grading(self) -> int:
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

    def resolved(self, scene: Scene) -> Model:
        """The scene's model as this law has it: its stiffness stands for a parabola."""
        return replace(scene.model, profile="parabola") if scene.has_geometry else scene.model

    def _until(self, scene: Scene) -> float:
        return scene.motion.end_time or END_IN_CONTACT_TIMES * self.elastic_contact_time(scene) * scene.motion.impacts

    def _answer(self, scene: Scene, until: float, step_tolerance: float) -> tuple[Answer, int]:
        """One integration, and how many steps it took."""
        moved = motion(self, bodies_of(scene), self.exit, scene.motion.impacts, until, step_tolerance)
        track = Track(self, moved)
        said = "" if moved.end is End.SEPARATED else moved.end.value
        answer = Answer(
            track.rows,
            lambda times: self._columns(track, times),
            self._values(scene, track),
            moved.end,
            self._energy(scene, moved),
            "; ".join(part for part in (self.source, said) if part),
            until,
            tuple(_listed(track, one) for one in moved.contacts) if scene.motion.impacts > 1 else (),
        )
        return answer, sum(len(phase.steps) for one in moved.contacts for phase in one.phases)

    def _columns(self, track: Track, times: Array) -> Array:
        depth, rate, force = track(times)
        if self.exit == "force":
            force = np.maximum(force, 0.0)
        pressed = np.where(force > 0.0, np.maximum(depth, 0.0), 0.0)
        radius = np.zeros_like(depth) if self.load_curve is None else self.load_curve.contact_radius(pressed)
        return np.array([depth, rate, force, radius])

    def _values(self, scene: Scene, track: Track) -> Mapping[str, float | None]:
        moved, first = track.motion, track.motion.contacts[0]
        peaks = [peak_of(track, one) for one in moved.contacts]
        peak_time, peak_force = max(peaks, key=lambda peak: peak[1])
        separated = first.end is End.SEPARATED
        gained = sum(one.first.rate - one.last.rate for one in moved.contacts)
        fallen = scene.gravity * sum(one.end_time - one.start_time for one in moved.contacts)
        return {
            "peak_force": peak_force,
            "peak_time": peak_time,
            "peak_depth": max(one.deepest for one in moved.contacts),
            "duration": first.end_time if separated else None,
            "restitution": -first.last.rate / scene.velocity if separated else None,
            "impulse": scene.reduced_mass * (gained + fallen),
        }

    def _energy(self, scene: Scene, moved: Motion) -> dict[str, float | None]:
        """Energies at the end of the last contact, J, each on its own."""
        last, mass = moved.contacts[-1].last, scene.reduced_mass
        given = 0.5 * mass * scene.velocity**2 + mass * scene.gravity * last.depth
        out = 0.5 * mass * last.rate**2
        earlier = sum(self._locked(one) for one in moved.contacts[:-1])
        stored = self._locked(moved.contacts[-1])
        lost = last.lost + earlier
        return {"in": given, "out": out, "stored": stored, self.loss: lost, "residual": given - out - stored - lost}

    def _locked(self, one: Contact) -> float:
        """What is still stored when a contact ends; a surface that recovers before the next one loses it."""
        return float(self.stored(max(one.last.depth, 0.0), one.phases[-1].stage))


def bodies_of(scene: Scene) -> Bodies:
    """The relative motion of a scene."""
    return Bodies(scene.reduced_mass, scene.velocity, scene.gravity)


def peak_of(track: Track, one: Contact) -> tuple[float, float]:
    """Time, s, and height, N, of the highest force of a contact."""
    steps = [step for phase in one.phases for step in phase.steps]
    ends = one.start_time + np.cumsum([step.length for step in steps])
    i = int(np.argmax([step.force.max() for step in steps]))
    found = [(one.start_time, float(track(np.array([one.start_time]))[2, 0]))]
    # Where the highest point is the end of its step, the peak may lie before the first point of the next one.
    around = (i, i + 1) if i + 1 < len(steps) and steps[i].force.argmax() == steps[i].force.size - 1 else (i,)
    for k in around:
        found.append(_vertex(track, ends[k] - steps[k].length * (1.0 - np.append(0.0, steps[k].nodes.points))))
    return max(found, key=lambda peak: peak[1])


def _vertex(track: Track, places: Array) -> tuple[float, float]:
    """The highest force between the first and the last of ascending places: the vertex of ever smaller parabolas."""
    values = track(places)[2]
    i = int(np.argmax(values))
    time, height = float(places[i]), float(values[i])
    width = float(places[min(i + 1, places.size - 1)] - places[max(i - 1, 0)])
    for share in CLOSER:
        left, right = max(time - share * width, float(places[0])), min(time + share * width, float(places[-1]))
        low, middle, high = (float(force) for force in track(np.array([left, 0.5 * (left + right), right]))[2])
        bent, tilt = low - 2.0 * middle + high, low - high
        if bent < 0.0 and abs(tilt) < -2.0 * bent:
            shift, height = 0.5 * tilt / bent, middle - 0.125 * tilt**2 / bent
        else:
            shift, height = (-1.0, low) if tilt > 0.0 else (1.0, high)
        time = 0.5 * (left + right) + 0.5 * shift * (right - left)
    return time, height


def _listed(track: Track, one: Contact) -> dict[str, float | None]:
    """A contact in a list of several."""
    separated = one.end is End.SEPARATED
    peak_time, peak_force = peak_of(track, one)
    return {
        "start": one.start_time,
        "duration": one.end_time - one.start_time if separated else None,
        "velocity": one.first.rate,
        "restitution": -one.last.rate / one.first.rate if separated and one.first.rate > 0.0 else None,
        "peak_force": peak_force,
        "peak_time": peak_time,
        "peak_depth": one.deepest,
    }
