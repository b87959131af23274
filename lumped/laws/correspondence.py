"""The paper's law: elastic-viscoelastic correspondence, "(17)" to "(19)", as a convolution.

F(t) = int_0^t E*(t-s) d(y(s)), y the elastic load curve; contact ends at the first F = 0, as the paper clips
it. Exact while the contact radius grows (Lee and Radok 1960, doi 10.1115/1.3644020), an approximation in the
rebound. As a force between two masses that remembers it has any exit, and any
number of contacts.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray

from lumped.errors import FeContactError
from lumped.laws._force_law import ForceLaw
from lumped.laws._hereditary import Course, HereditaryLaw, Solve, once, simulation
from lumped.laws._parameters import EXIT_KEY
from lumped.laws.base import LawKind, check_load_curve, waves
from lumped.laws.mdr import ImpactScales
from lumped.numbers import Array, Real
from lumped.result.history import End
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.scene.tables import Model
from lumped.schema.keys import Choice, Key, keys_of
from lumped.solvers.hereditary.approach import approach
from lumped.solvers.hereditary.closing import Closing, close
from lumped.solvers.hereditary.march import Settings
from lumped.solvers.hereditary.path import HereditaryPhase, Path, SinceTouch, UntilEnd
from lumped.solvers.hereditary.pieces import DEPTH, Followed
from lumped.solvers.hereditary.problem import Hereditary
from lumped.solvers.point.bodies import TINY, Bodies, Dent, Stage, State, Step
from lumped.solvers.point.memory import RULES, FreeSurface, HeldSurface, HereditaryLoad, StepLoad, rule_of
from lumped.solvers.radau import NODES, through_zero

ROUGH, FINE = 1e-3, 1e-6  # tolerances of scales
FORGOTTEN = 1e-12  # rounding: of its load where contact ended, what a surface has still to creep back


@dataclass(frozen=True, kw_only=True)
class HereditaryForce(ForceLaw):
    """F = int E*(t-s) dy, "(17)" to "(19)"; `rule` says what is remembered between contacts, `scale` is a time, s."""

    load: HereditaryLoad
    rule: str
    scale: float
    within_step: StepLoad | None = None
    name: ClassVar[str] = "correspondence"
    remembers: ClassVar[bool] = True

    @property
    def tensile(self) -> bool:
        """By what it remembers."""
        return True

    @property
    def parameters(self) -> dict[str, object]:
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

    def force(self, depth: Real, rate: Real, stage: Stage) -> Real:
        """F at the points of the step, N."""
        return self._step.force(depth, rate)

    def tangents(self, depth: Real, rate: Real, stage: Stage) -> tuple[Real, Real]:
        """Slopes at the points of the step."""
        return self._step.tangents(depth, rate)

    def carried(self, depth: float, stage: Stage) -> float:
        """Not known: it creeps."""
        return math.nan

    def lost(self, depth: Real, rate: Real, stage: Stage) -> Real:
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
        force, (load, slope) = np.zeros_like(depth), map(np.asarray, self.load.load_and_slope(depth))
        for index in np.unique(place):
            here, step = place == index, steps[index]
            there = StepLoad.of(self.load, step.start.memory, step.length, NODES)
            values = np.column_stack([there.memory, there.memories(np.maximum(step.depth, TINY))])
            remembered = values @ through_zero(share[here]).T
            force[here] = self.load.pressing(load[here], slope[here], rate[here], remembered)
        return force

    def returned(self, bodies: Bodies, last: State) -> tuple[float, State] | None:
        """As the rule has it."""
        return rule_of(self.rule)(self.load, bodies, last)

    @property
    def follows(self) -> bool:
        """By the rule "continuous", where it must not pull."""
        return self.rule == "continuous" and self.exit == "force"

    def at_start(self, depth: float, rate: float, memory: tuple[float, ...]) -> float:
        """F of the depth, its rate and the memories, N."""
        return float(self.load.force(depth, rate, memory))

    def dent(self, last: State, stage: Stage) -> Dent:
        """As the rule has it; one that is left at depth zero by the rule "continuous" is none, but it remembers."""
        surface = FreeSurface.of(self.load, last) if self.rule != "continuous" else HeldSurface.of(self.load, last)
        return HereditaryDent(self, stage, surface)

    def resolved(self, scene: Scene) -> Model:
        """The scene's own profile; nothing yields."""
        return replace(scene.model, plasticity=False)

    @property
    def _step(self) -> StepLoad:
        assert self.within_step is not None
        return self.within_step


@dataclass(frozen=True)
class HereditaryDent(Dent):
    """A surface between contacts, free or held, by what it remembers."""

    law: HereditaryForce
    surface: FreeSurface | HeldSurface

    def resistance(self, depth: Array, rate: Array, since: Array) -> Array:
        """By how much the load of the depth, odd in it, is above that of the surface, m2."""
        load = self.law.load
        return np.asarray(load.load(depth) - load.load(-depth) - self.surface.at(since)[0])

    def recalled(self, since: float) -> tuple[float, ...]:
        """The memories by then."""
        return tuple(self.surface.at(since)[1:].tolist())

    def forgotten(self, since: float) -> bool:
        """At once by the rule "reset", else when nothing is left that counts beside what was."""
        return self.law.rule == "reset" or bool(np.abs(self.surface.at(since)).max() <= self._nothing)

    @cached_property
    def _nothing(self) -> float:
        return FORGOTTEN * float(np.abs(self.surface.at(0.0)).max())


def leaves_out(scene: Scene) -> str:
    """Nothing but waves where nothing has to be remembered, or the same area always bears the load."""
    if scene.contact_modulus.is_elastic:
        return waves(scene)
    if scene.law is not None and scene.law.name == Correspondence.name and of(scene) != Correspondence():
        return "that no surface pulls, and that it recovers between impacts"
    if scene.geometry.target.fixed_radius(scene.geometry.shape) is not None:
        return waves(scene)
    return "that a surface remembers a contact which shrinks otherwise than one which grows"


def law_of(scene: Scene, exit: str = "force", rule: str = "recovering") -> HereditaryForce:
    """The law for a scene, on the load curve of its target. Raises BadInput where no load curve is known."""
    curve = scene.load_curve
    load = HereditaryLoad(curve, scene.contact_modulus.scaled(scene.geometry.shape.total))
    ends = "depth" if load.modulus.is_elastic else exit  # where an elastic force returns to zero
    return HereditaryForce(exit=ends, rule=rule, load=load, scale=scene.elastic_contact_time, load_curve=curve)


@dataclass(frozen=True)
class Correspondence(HereditaryLaw):
    """The law; the rest is in the scene.

    `exit`: contact ends when the force returns to zero ("force", as the paper clips it) or at depth zero ("depth",
    the surface pulls). `memory`: what is left of it when the bodies meet again, by its name in
    `RULES` of :mod:`lumped.solvers.point.memory`.
    """

    exit: Annotated[str, EXIT_KEY] = "force"
    memory: Annotated[str, Key(Choice(tuple(RULES)), "what is left of it at the next contact")] = "recovering"
    name: ClassVar[str] = "correspondence"

    @property
    def solve(self) -> Solve | None:
        """That which ends with the force."""
        return solve if self.exit == "force" else None

    def simulation(self, scene: Scene, tolerance: float, dense: bool = True) -> Followed[Result]:
        """The impacts of a scene to this tolerance; several, or another exit, in steps. Raises NotReached."""
        if self.exit == "force" and scene.motion.impacts == 1:
            return (yield from simulation(self.name, scene, tolerance, solve, _lost_in_rounding, dense))
        return law_of(scene, self.exit, self.memory).simulate(scene, tolerance)


def of(scene: Scene) -> Correspondence:
    """The law for a scene, with the choices of `[law]`. Raises BadInput for a target without a load curve."""
    check_load_curve(scene, Correspondence.name)
    law = scene.law
    return Correspondence(**(law.values if law is not None and law.name == Correspondence.name else {}))


def estimate(scene: Scene, by: Solve | None = None) -> ImpactScales:
    """Scales of the impact on any target with a load curve: one integration, no bars. Raises NotReached, BadInput.

    ``by``: that of another law with memory, as long as it gets on; None: this one's.
    """
    try:
        answer = once(scene, ROUGH, by or solve)
    except FeContactError:  # a long step may try depths beyond the load curve which the motion never sees
        answer = once(scene, FINE, solve)
    value = {name: quantity or 0.0 for name, quantity in answer.values.items()}
    return ImpactScales(
        contact_radius=float(answer.columns(answer.times)[3].max()),
        peak_depth=value["peak_depth"],
        peak_force=value["peak_force"],
        peak_time=value["peak_time"],
        end=float(answer.times[-1]),
        duration=answer.values["duration"],
        restitution=answer.values["restitution"],
    )


def solve(problem: Hereditary, end_time: float, settings: Settings, before: Course | None = None) -> Followed[Course]:
    """One integration from touch to the first F = 0, or to `end_time` in its own units. Raises NotReached."""
    inward = yield from approach(problem, end_time, settings, before.inward if before else None)
    if not inward.turned:
        return Course((_phase(inward.path),), End.REST if inward.rests else End.TIME, inward.steps, inward)
    known = before.outward if before and isinstance(before.outward, Closing) else None
    closing = yield from close(problem, inward, end_time, settings, known)
    steps = inward.steps + closing.steps
    phases = (_phase(closing.path),) if closing.path else ()
    if closing.last is None:
        return Course(phases, End.TIME, steps, inward, closing)
    last = HereditaryPhase(closing.last, UntilEnd(closing.end), DEPTH, DEPTH)
    return Course((*phases, last), End.SEPARATED, steps, inward, closing)


def _lost_in_rounding(problem: Hereditary, course: Course) -> tuple[dict[str, float], float]:
    """Of the end, and of what gravity does to the velocity meanwhile: the force of an elastic cone falls as a square,
    whose zero is known to the root of rounding. Of the force nothing.
    """
    if not isinstance(course.outward, Closing):
        return {}, 0.0
    blur = course.outward.blur
    return {"duration": blur * problem.scales.time, "restitution": abs(problem.gravity) * blur}, 0.0


def _phase(path: Path) -> HereditaryPhase:
    return HereditaryPhase(path, SinceTouch(), DEPTH, DEPTH)


MEMBER = LawKind(of, __doc__, (keys_of(Correspondence),), leaves_out=leaves_out, seconds=0.005)
