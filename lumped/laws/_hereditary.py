"""What the laws with memory share: two integrations, the bars from their difference, the Result."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from lumped.laws._assembly import Answer, assemble, bars, values_of
from lumped.numbers import Array, Clock
from lumped.result.history import End
from lumped.result.result import Result, meets
from lumped.scene.geometry import stiffest_impact
from lumped.scene.scene import Scene
from lumped.solvers.hereditary.approach import Approach
from lumped.solvers.hereditary.closing import Closing
from lumped.solvers.hereditary.march import Settings
from lumped.solvers.hereditary.path import HereditaryPhase
from lumped.solvers.hereditary.pieces import Followed, alone
from lumped.solvers.hereditary.problem import Hereditary
from lumped.solvers.hereditary.rebound import Rebound

# The force may err by this share of the tolerance in each piece.
LOCAL_SHARE = 1e-1
LOOSEST, TIGHTEST = 1e-5, 1e-13  # of the integration's relative tolerance: safety, and rounding beyond it
NEXT = 1e-2  # work: times the tolerance, where a bar was missed
# The pieces chosen with few nodes are solved again with more, which err less by orders: the difference is the bar.
FEW, MORE = 12, 18
MEET = 1e-9  # rounding: where two phases meet they differ by less, relatively
SAFETY = 1.5  # safety: of the bars, over the change from few points to more


@dataclass(frozen=True, eq=False)
class Course:
    """One integration: its phases one after the other, how it ended, the Newton steps it took.

    `inward` and `outward` are what it was made of, for a second one with more nodes.
    """

    phases: tuple[HereditaryPhase, ...]
    end: End
    steps: int
    inward: Approach
    outward: Rebound | Closing | None = None

    @property
    def times(self) -> Array:
        """Times that lie densely, shape (n,), ascending."""
        return np.concatenate([self.phases[0].times, *(phase.times[1:] for phase in self.phases[1:])])

    def highest(self, field: int) -> tuple[float, float]:
        """When a field is highest, 0 the depth and 3 the force, and how high."""
        samples = [phase.samples(field) for phase in self.phases]
        tops = [float(values.max()) for values in samples]
        near = max(tops) - MEET * abs(max(tops))
        every = zip(self.phases, samples, tops, strict=True)
        return max(
            (phase.highest(field, values) for phase, values, top in every if top >= near), key=lambda one: one[1]
        )

    def at(self, times: Array) -> Array:
        """Depth, velocity, force and the edge's depth, shape (4, n); a striker at rest stays so, without force."""
        found = np.empty((4, times.size))
        for phase, inside in self._shared(times):
            found[:, inside] = phase.at(times[inside])
        if self.end is End.REST:
            found[1:3, self._rested(times)] = 0.0
        return found

    def force(self, times: Array) -> Array:
        """The force alone, shape (n,)."""
        found = np.empty(times.size)
        for phase, inside in self._shared(times):
            found[inside] = phase.force(times[inside])
        if self.end is End.REST:
            found[self._rested(times)] = 0.0
        return found

    def _shared(self, times: Array) -> Iterator[tuple[HereditaryPhase, NDArray[np.bool_]]]:
        """The phases that know some of the times, and which; where two meet the later one speaks."""
        which = self._ends[:-1].searchsorted(times, side="right")
        for i, phase in enumerate(self.phases):
            if (inside := which == i).any():
                yield phase, inside

    def _rested(self, times: Array) -> NDArray[np.bool_]:
        """Which of the times are those after the last piece."""
        return np.asarray(times > self._ends[-1] * (1.0 + 1e-12))

    @cached_property
    def _ends(self) -> Array:
        return np.array([phase.times[-1] for phase in self.phases])


class Solve(Protocol):
    """One integration of a law, perhaps on the pieces of one `before`; times in units of the problem."""

    def __call__(
        self, problem: Hereditary, end_time: float, settings: Settings, before: Course | None = None
    ) -> Followed[Course]: ...


class HereditaryLaw(ABC):
    """A law that says of a load curve and a modulus how the force follows the depth."""

    needs_mass: ClassVar[bool] = True

    @property
    @abstractmethod
    def solve(self) -> Solve | None:
        """One integration, where one of :func:`once` says all; None where contacts follow one another in steps."""

    @abstractmethod
    def simulation(self, scene: Scene, tolerance: float, dense: bool = True) -> Followed[Result]:
        """As `simulate`, by pieces that may be solved together with those of other impacts.

        Not `dense`: the history has the rows of the integration alone.
        """

    def simulate(self, scene: Scene, tolerance: float) -> Result:
        """The impacts of a scene to this tolerance. Raises NotReached."""
        return alone(self.simulation(scene, tolerance))


# What a law itself leaves open of an integration: errors of quantities, and of the force, N; SI.
Inexact = Callable[[Hereditary, Course], tuple[dict[str, float], float]]


def simulation(
    name: str, scene: Scene, tolerance: float, solve: Solve, inexact: Inexact | None = None, dense: bool = True
) -> Followed[Result]:
    """Integrate tighter and tighter until every bar is within the tolerance. Raises NotReached.

    No integration mends what is `inexact`, which the bars have on top. `dense` as in :class:`HereditaryLaw`.
    """
    clock, time = Clock(), scene.elastic_contact_time
    problem, last = problem_of(scene), scene.end_time / time
    rtol, evaluations = min(max(tolerance * LOCAL_SHARE, TIGHTEST), LOOSEST), 0
    while True:
        few = yield from solve(problem, last, Settings(rtol, FEW))
        more = yield from solve(problem, last, Settings(rtol, MORE), few)
        evaluations += FEW * few.steps + MORE * more.steps
        fine = answer_of(scene, problem, more)
        quantities, force_error = bars(fine, answer_of(scene, problem, few), SAFETY)
        if meets(quantities, tolerance) or rtol * NEXT < TIGHTEST:
            break
        rtol *= NEXT
    errors, lost = inexact(problem, more) if inexact else ({}, 0.0)
    for known, error in errors.items():
        one = quantities[known]
        quantities[known] = one if one.error is None else replace(one, error=one.error + error)
    force_error += lost
    numerics = {"integrator": "Radau", "rtol": rtol, "points": MORE}
    work = {"force_evaluations": evaluations}
    return assemble(name, scene, tolerance, fine, quantities, force_error, clock, numerics, work, dense=dense)


def problem_of(scene: Scene) -> Hereditary:
    """The problem of a scene, on the load curve of its target; its unit of time is the elastic contact time."""
    mass, velocity = scene.reduced_mass, scene.velocity
    shortest = stiffest_impact(scene.profile, scene.contact_modulus, mass, velocity).duration
    modulus = scene.contact_modulus.scaled(scene.geometry.shape.total)
    return Hereditary.of(scene.load_curve, modulus, mass, velocity, scene.gravity, scene.elastic_contact_time, shortest)


def once(scene: Scene, rtol: float, solve: Solve) -> Answer:
    """One integration of a scene, without bars. Raises NotReached."""
    problem = problem_of(scene)
    return answer_of(scene, problem, alone(solve(problem, scene.end_time / problem.scales.time, Settings(rtol))))


def answer_of(scene: Scene, problem: Hereditary, course: Course) -> Answer:
    """What an integration says, in SI."""
    scales, last = problem.scales, course.phases[-1]
    (peak_time, force), (_, depth) = course.highest(3), course.highest(0)
    state = last.last
    velocity, time = float(state[1]) * scales.velocity, float(last.times[-1]) * scales.time
    peak = (peak_time * scales.time, force * scales.force)
    values = values_of(scene, course.end, peak, depth * scales.depth, velocity, time)
    said = "" if course.end is End.SEPARATED else course.end.value
    columns = _HereditaryColumns(problem, course)
    energy, mass = _energy(scene, problem, state), scene.reduced_mass
    return Answer(course.times * scales.time, columns, values, course.end, energy, said, mass=mass)


@dataclass(frozen=True, eq=False)
class _HereditaryColumns:
    """Depth, velocity, force and contact radius at times (n,), s; shape (4, n), SI."""

    problem: Hereditary
    course: Course

    def __call__(self, times: Array) -> Array:
        scales = self.problem.scales
        depth, velocity, force, edge = self.course.at(times / scales.time)
        radius = self.problem.contact_radius(np.maximum(edge, 0.0))
        force = np.maximum(force, 0.0) * scales.force
        return np.array([depth * scales.depth, velocity * scales.velocity, force, radius])

    def force(self, times: Array) -> Array:
        """The force alone, N."""
        scales = self.problem.scales
        return np.asarray(np.maximum(self.course.force(times / scales.time), 0.0) * scales.force)


def _energy(scene: Scene, problem: Hereditary, last: Array) -> dict[str, float | None]:
    """Energies, J. `viscous` is the work done on the target and not given back: spent by now, or later."""
    depth, velocity, work = (float(value) for value in last[:3])
    unit = scene.reduced_mass * scene.velocity**2
    given, out = 0.5 * unit + unit * problem.gravity * depth, 0.5 * unit * velocity**2
    return {"in": given, "out": out, "viscous": unit * work, "residual": given - out - unit * work}
