"""What every law that is a force between two masses is, and the impacts of a scene under it: march, bars, Result."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cache, partial
from typing import ClassVar, NamedTuple

import numpy as np

from lumped import laws
from lumped.errors import BadInput, Fault
from lumped.laws._assembly import DIGITS, LAST_DIGIT, Answer, assemble, bars, impulse_of, small_model, values_of_several
from lumped.load_curves.base import LoadCurve
from lumped.numbers import Array, Clock
from lumped.result.history import End
from lumped.result.result import UNITS, Quantity, Result, meets
from lumped.scene.scene import Scene
from lumped.scene.tables import Model
from lumped.solvers.point.bodies import TINY, Bodies, PointLaw, State
from lumped.solvers.point.contact import Contact, PointMotion, motion
from lumped.solvers.point.half_widths import half_widths
from lumped.solvers.point.phase import PointPhase
from lumped.solvers.point.track import Outcome, PointTrack, outcome_of

# Errors of the rate allowed in one step, relative to the velocity at touch: the history errs far less, its end less
# again. The first one is that asked of the result, if it is not beyond these; every next one is finer by FINER.
COARSEST, FINEST, FINER = 1e-5, 1e-12, 1e-2
# Whatever is asked, a contact's duration, relative, and restitution are known to this; to that where marches are
# compared, which takes two of them.
END, END_COMPARED = 1e-11, 1e-8
# Of the end's error before, at least so much is left: finer steps find rounding alone.
NO_BETTER = 0.5
# Two marches may agree by chance.
SAFETY = 2.0


@dataclass(frozen=True, kw_only=True)
class ForceLaw(PointLaw):
    """F(depth, rate) of two masses.

    `exit`: contact ends when the force returns to zero ("force", no tension) or at depth zero ("depth").
    `gap`: distance before touch, m; time starts at touch. `load_curve`: that of the scene the law was
    made for, whose contact radius the history shows; None: without geometry, and in plane strain, it shows zero.
    `source`: in words, what was taken of the scene.
    """

    exit: str = "force"
    gap: float = 0.0
    load_curve: LoadCurve | None = None
    source: str = ""
    name: ClassVar[str]
    # Where the loss belongs among the energies of a Result.
    loss: ClassVar[str] = "viscous"
    needs_mass: ClassVar[bool] = True
    # Whether the force depends on the path, not only on where it turned.
    remembers: ClassVar[bool] = False

    @property
    def follows(self) -> bool:
        """Whether the surface goes along without force where it would pull, and pushes again as soon as it can."""
        return False

    def at_start(self, depth: float, rate: float, memory: tuple[float, ...]) -> float:
        """The force where a contact begins, N, of a law that follows."""
        return math.nan

    @property
    def parameters(self) -> dict[str, object]:
        """Its numbers by the names of the scene file."""
        return {f.name: getattr(self, f.name) for f in fields(self) if f.name not in ("load_curve", "source")}

    def elastic_contact_time(self, scene: Scene) -> float:
        """Contact time without damping, s."""
        return self.time_scale(bodies_of(scene))

    def simulate(self, scene: Scene, tolerance: float) -> Result:
        """The impacts of a scene to this tolerance. Raises TooManySteps."""
        clock, compared = Clock(), scene.motion.impacts > 1 or self.remembers
        end = END_COMPARED if compared else END
        marched = cache(partial(_marched, self, scene))  # what is coarse in a round was fine in the one before
        step_tolerance, steps, known = _first(tolerance), 0, math.inf
        while True:
            judged = _compared(marched, step_tolerance) if compared else _estimated(self, scene, step_tolerance)
            steps += judged.steps
            before, known = known, _end_error(judged.quantities)
            ends_well = known <= end or known > NO_BETTER * before
            if step_tolerance <= FINEST or (meets(judged.quantities, tolerance) and ends_well):
                break
            step_tolerance *= FINER
        answer, quantities, force_error, _ = judged
        numerics = {"integrator": "Radau collocation", "step_tolerance": step_tolerance, "law": self.parameters}
        work, model = {"steps": steps}, self.resolved(scene)
        return assemble(self.name, scene, tolerance, answer, quantities, force_error, clock, numerics, work, model)

    def outcome(self, scene: Scene, tolerance: float = 1e-6) -> Outcome:
        """What a study of many impacts needs of the first contact, by one march and without bars. Raises TooManySteps.

        `tolerance`: relative; the march is as fine as that of a Result which meets it at once.
        """
        track = _track(self, scene, 1, _first(tolerance))
        return outcome_of(track, track.motion.contacts[0])

    def resolved(self, scene: Scene) -> Model:
        """The scene's model as this law has it: its stiffness stands for a parabola, and no body for waves."""
        return replace(small_model(scene.model), profile="parabola") if scene.has_geometry else scene.model


def between_masses(name: str, scene: Scene) -> ForceLaw:
    """The law called so, made for a scene. Raises BadInput, also where it is no force between two masses."""
    law = laws.get(name).of(scene)
    if not isinstance(law, ForceLaw):
        raise BadInput(Fault(scene.source, "law.name", f"{name} is no force between two masses; accepted: one that is"))
    return law


class JudgedImpact(NamedTuple):
    """A march: what it says, its quantities with bars, the bar of the force, N, and how many steps it took."""

    answer: Answer
    quantities: Mapping[str, Quantity]
    force_error: float
    steps: int


def bodies_of(scene: Scene) -> Bodies:
    """The relative motion of a scene."""
    return Bodies(scene.reduced_mass, scene.velocity, scene.gravity)


def _first(tolerance: float) -> float:
    return min(max(tolerance, FINEST), COARSEST)


def _estimated(law: ForceLaw, scene: Scene, step_tolerance: float) -> JudgedImpact:
    """One contact, whose bars are what its march still lacks, estimated from its defect."""
    track = _track(law, scene, 1, step_tolerance)
    said = outcome_of(track, track.motion.contacts[0])
    answer = _answer(law, scene, track, [said])
    widths = half_widths(track, bodies_of(scene), law.exit, said, answer.values["impulse"] or 0.0)
    values = {**answer.values, "history_l2": 0.0}
    quantities = {
        name: Quantity(values[name], None if values[name] is None else getattr(widths, name), unit)
        for name, unit in UNITS.items()
    }
    return JudgedImpact(answer, quantities, widths.force, track.motion.steps)


def _compared(marched: Callable[[float], tuple[Answer, int]], step_tolerance: float) -> JudgedImpact:
    """Contacts whose bars are their distance from those of a march a hundred times less fine."""
    fine, steps = marched(max(step_tolerance * FINER, FINEST))
    coarse, _ = marched(max(step_tolerance, FINEST / FINER))
    return JudgedImpact(fine, *bars(fine, coarse, SAFETY), steps)


def _marched(law: ForceLaw, scene: Scene, step_tolerance: float) -> tuple[Answer, int]:
    """What all contacts of one march say, and how many steps it took."""
    track = _track(law, scene, scene.motion.impacts, step_tolerance)
    outcomes = [outcome_of(track, one) for one in track.motion.contacts]
    return _answer(law, scene, track, outcomes), track.motion.steps


def _end_error(quantities: Mapping[str, Quantity]) -> float:
    """How well the end of a contact that ends is known: its duration's bar, relative, or the restitution's."""
    duration, restitution = quantities["duration"], quantities["restitution"]
    return max((duration.error or 0.0) / (duration.value or math.inf), restitution.error or 0.0)


def _until(law: ForceLaw, scene: Scene) -> float:
    return scene.end_time_of(law.elastic_contact_time(scene))


def _track(law: ForceLaw, scene: Scene, impacts: int, step_tolerance: float) -> PointTrack:
    return PointTrack(law, motion(law, bodies_of(scene), law.exit, impacts, _until(law, scene), step_tolerance))


def _answer(law: ForceLaw, scene: Scene, track: PointTrack, outcomes: Sequence[Outcome]) -> Answer:
    """What a march says."""
    moved, until = track.motion, _until(law, scene)
    last = moved.contacts[-1]
    impulse = impulse_of(scene, moved.end, last.last.rate, last.end_time, until)
    said = _fewer(scene, len(outcomes)) if moved.end is End.SEPARATED else moved.end.value
    stiff = () if law.remembers else tuple(_stiffest(law, one) for one in moved.contacts)
    return Answer(
        track.rows,
        _ImpactColumns(law, track),
        values_of_several(outcomes, impulse),
        moved.end,
        _energy(law, scene, moved),
        "; ".join(part for part in (law.source, said) if part),
        until,
        tuple(outcome._asdict() for outcome in outcomes) if scene.motion.impacts > 1 else (),
        scene.reduced_mass,
        max((one.largest for one in stiff), default=0.0),
        scene.reduced_mass * (scene.velocity + abs(last.last.rate) + abs(scene.gravity) * last.end_time),
        _rounded(stiff, scene, moved) if stiff else {},
        _late(law, stiff, scene, moved) if stiff and scene.motion.impacts > 1 else (),
    )


class Stiffest(NamedTuple):
    """Of a contact the `largest` stiffness times its depth, N, by which a digit of the depth is more than one of the
    force; its integral over time, N s, that of its square, N2 s, and that of the square of the force.
    """

    largest: float
    passed: float
    squared: float
    squared_force: float


def _stiffest(law: ForceLaw, one: Contact) -> Stiffest:
    """That of a contact, from the nodes of its steps."""
    largest = passed = squared = squared_force = 0.0
    for stage, step in ((phase.stage, step) for phase in one.phases for step in phase.steps):
        pressed = np.maximum(step.depth, TINY)
        stiff = np.abs(law.tangents(pressed, step.rate, stage)[0] * pressed)
        largest = max(largest, float(stiff.max()))
        passed += step.length * float(stiff.mean())
        squared += step.length * float((stiff**2).mean())
        squared_force += step.length * float((step.force**2).mean())
    return Stiffest(largest, passed, squared, squared_force)


def _rounded(stiff: Sequence[Stiffest], scene: Scene, moved: PointMotion) -> dict[str, float]:
    """What the last digit of the depth changes: of a force so steep that it falls within few digits a good share.

    That sends the striker off at another speed, and the slower it leaves the later it is out.
    """
    force = math.sqrt(sum(one.squared_force for one in stiff))
    speed = LAST_DIGIT * stiff[0].passed / scene.reduced_mass
    leaving = abs(moved.contacts[0].last.rate)
    return {
        "history_l2": DIGITS * math.sqrt(sum(one.squared for one in stiff)) / force if force else 0.0,
        "duration": moved.contacts[0].end_time * min(speed / leaving, 1.0) if leaving else 0.0,
        "restitution": speed / scene.velocity,
    }


def _late(
    law: ForceLaw, stiff: Sequence[Stiffest], scene: Scene, moved: PointMotion
) -> tuple[tuple[float, float], ...]:
    """By how much rounding of depths and rates lets each contact begin later or sooner, s, and its first force, N.

    A flight lasts twice the speed over gravity; and who leaves the more slowly, leaves the later.
    """
    late = [0.0]
    for one, met in zip(moved.contacts[:-1], stiff[:-1], strict=True):
        speed = LAST_DIGIT * (abs(one.first.rate) + met.passed / scene.reduced_mass)
        lasted, leaving = one.end_time - one.start_time, abs(one.last.rate)
        flight = 2.0 * speed / scene.gravity if scene.gravity > 0.0 else 0.0
        late.append(late[-1] + flight + (lasted * min(speed / leaving, 1.0) if leaving else 0.0))
    jumps = [
        float(law.force(max(one.first.depth, TINY), one.first.rate, one.phases[0].stage)) for one in moved.contacts
    ]
    return tuple(zip(late, jumps, strict=True))


def _fewer(scene: Scene, contacts: int) -> str:
    """What to say when the bodies parted after fewer contacts than asked for."""
    asked = scene.motion.impacts
    return "" if contacts == asked else f"{contacts} of {asked} impacts: the bodies did not meet again before the end"


class _ImpactColumns(NamedTuple):
    """Depth, velocity, force and contact radius at times (n,), shape (4, n); no tension where contact ends by force."""

    law: ForceLaw
    track: PointTrack

    def __call__(self, times: Array) -> Array:
        depth, rate, force = self.track(times)
        force, curve = self._pushing(force), self.law.load_curve
        pressed = np.where(force > 0.0, np.maximum(depth, 0.0), 0.0)
        radius = np.zeros_like(depth) if curve is None else curve.contact_radius(pressed)
        return np.array([depth, rate, force, radius])

    def force(self, times: Array) -> Array:
        """The force alone, shape (n,), N."""
        return self._pushing(self.track(times)[2])

    def _pushing(self, force: Array) -> Array:
        return np.maximum(force, 0.0) if self.law.exit == "force" else force


def _energy(law: ForceLaw, scene: Scene, moved: PointMotion) -> dict[str, float | None]:
    """Energies at the end of the last contact, J, each on its own."""
    last, mass = moved.contacts[-1].last, scene.reduced_mass
    given = 0.5 * mass * scene.velocity**2 + mass * scene.gravity * last.depth
    out = 0.5 * mass * last.rate**2
    stored = [_stored(law, one.last, one.phases[-1]) for one in moved.contacts]
    found = [_stored(law, one.first, one.phases[0]) for one in moved.contacts[1:]]
    # What a contact leaves behind and the next one does not find is lost: the surface recovers in between.
    lost = last.lost + sum(stored[:-1]) - sum(found)
    residual = given - out - stored[-1] - lost
    return {"in": given, "out": out, "stored": stored[-1], law.loss: lost, "residual": residual}


def _stored(law: ForceLaw, state: State, phase: PointPhase) -> float:
    """What is stored where a phase begins or ends, J."""
    return float(law.stored(max(state.depth, 0.0), phase.stage))
