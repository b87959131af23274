"""What the laws with memory share: two integrations, the bars from their difference, the Result."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.ending import End
from lumped.hereditary.march import POINTS, Settings
from lumped.hereditary.phase import Phase
from lumped.hereditary.problem import Hereditary
from lumped.laws._assembly import Answer, Clock, assemble, bars
from lumped.materials import Relaxation
from lumped.result import Result, meets
from lumped.scene import Model, Scene
from lumped.shapes import Shape

Array = NDArray[np.float64]
# The force may err by this share of the tolerance in each piece.
LOCAL_SHARE = 1e-1
LOOSEST, TIGHTEST = 1e-5, 1e-13
NEXT = 1e-2
# The looser integration is the bar of the tighter one, which errs several times less.
SAFETY = 2.0


@dataclass(frozen=True, eq=False)
class Course:
    """One integration: its phases one after the other, how it ended, the Newton steps it took."""

    phases: tuple[Phase, ...]
    end: End
    steps: int

    @property
    def times(self) -> Array:
        """Times that lie densely, shape (n,), ascending."""
        return np.concatenate([self.phases[0].times, *(phase.times[1:] for phase in self.phases[1:])])

    def highest(self, field: int) -> tuple[float, float]:
        """When a field is highest, 0 the depth and 3 the force, and how high."""
        return max(self.phases, key=lambda phase: phase.top(field)).highest(field)

    def at(self, times: Array) -> Array:
        """Depth, velocity, force and the edge's depth, shape (4, n); a striker at rest stays so, without force."""
        found = np.empty((4, times.size))
        begin = -np.inf
        for phase in self.phases:
            inside = times >= begin
            found[:, inside] = phase.at(times[inside])
            begin = float(phase.times[-1])
        after = times > begin * (1.0 + 1e-12)
        if self.end is End.REST:
            found[1:3, after] = 0.0
        return found


Solve = Callable[[Hereditary, float, Settings], Course]


def simulate(
    name: str,
    scene: Scene,
    profile: Shape,
    modulus: Relaxation,
    tolerance: float,
    solve: Solve,
    model: Model | None = None,
    message: str = "",
) -> Result:
    """Integrate tighter and tighter until every bar is within the tolerance. Raises NotReached."""
    clock = Clock()
    rtol = min(max(tolerance * LOCAL_SHARE, TIGHTEST / NEXT), LOOSEST)
    coarse, steps = once(scene, profile, modulus, rtol, solve, message)
    while True:
        rtol *= NEXT
        fine, more = once(scene, profile, modulus, rtol, solve, message)
        steps += more
        quantities, force_error = bars(fine, coarse, SAFETY)
        if meets(quantities, tolerance) or rtol * NEXT < TIGHTEST:
            break
        coarse = fine
    numerics = {"integrator": "Radau", "rtol": rtol, "points": POINTS}
    work = {"force_evaluations": steps * POINTS}
    return assemble(name, scene, tolerance, fine, quantities, force_error, clock, numerics, work, model)


def once(
    scene: Scene, profile: Shape, modulus: Relaxation, rtol: float, solve: Solve, message: str = ""
) -> tuple[Answer, int]:
    """One integration, without bars, and its Newton steps. Raises NotReached."""
    time = scene.elastic_contact_time
    problem = Hereditary.of(profile, modulus, scene.reduced_mass, scene.velocity, scene.gravity, time)
    course = solve(problem, scene.end_time / time, Settings(rtol))
    return _answer(scene, problem, course, message), course.steps


def _answer(scene: Scene, problem: Hereditary, course: Course, message: str) -> Answer:
    scales, separated = problem.scales, course.end is End.SEPARATED
    (peak_time, force), (_, depth) = course.highest(3), course.highest(0)
    last = course.phases[-1]
    velocity, duration = float(last.last[1]) * scales.velocity, float(last.times[-1]) * scales.time
    impulse = scene.reduced_mass * (scene.velocity - velocity + scene.gravity * duration)
    values: Mapping[str, float | None] = {
        "peak_force": force * scales.force,
        "peak_time": peak_time * scales.time,
        "peak_depth": depth * scales.depth,
        "duration": duration if separated else None,
        "restitution": -velocity / scene.velocity if separated else None,
        "impulse": None if course.end is End.SECOND_APPROACH else impulse,
    }
    said = "; ".join(part for part in (message, "" if separated else course.end.value) if part)
    columns = _Columns(problem, course)
    return Answer(course.times * scales.time, columns, values, course.end, _energy(scene, problem, last.last), said)


@dataclass(frozen=True, eq=False)
class _Columns:
    """Depth, velocity, force and contact radius at times (n,), s; shape (4, n), SI."""

    problem: Hereditary
    course: Course

    def __call__(self, times: Array) -> Array:
        scales = self.problem.scales
        depth, velocity, force, edge = self.course.at(times / scales.time)
        radius = self.problem.contact_radius(np.maximum(edge, 0.0))
        force = np.maximum(force, 0.0) * scales.force
        return np.array([depth * scales.depth, velocity * scales.velocity, force, radius])


def _energy(scene: Scene, problem: Hereditary, last: Array) -> dict[str, float | None]:
    """Energies, J. `viscous` is the work done on the target and not given back: spent by now, or later."""
    depth, velocity, work = (float(value) for value in last[:3])
    unit = scene.reduced_mass * scene.velocity**2
    given, out = 0.5 * unit + unit * problem.gravity * depth, 0.5 * unit * velocity**2
    return {"in": given, "out": out, "viscous": unit * work, "residual": given - out - unit * work}
