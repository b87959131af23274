"""The method of dimensionality reduction: the half-space exactly, by a row of springs (numpy only)."""

from __future__ import annotations

from dataclasses import dataclass

from lumped.scene import Scene
from lumped.spring_row.march import End, Track, march
from lumped.spring_row.pace import Adaptive
from lumped.spring_row.row import Instant, Problem

MOST_STEPS = 200_000


@dataclass(frozen=True)
class ImpactScales:
    """Scales of one impact: m, m, N, s, s, s. `duration` is None without separation before the end time.

    `end` is the last time followed; `restitution` None without separation.
    """

    contact_radius: float
    peak_depth: float
    peak_force: float
    peak_time: float
    turn_time: float
    end: float
    duration: float | None
    restitution: float | None


def estimate(scene: Scene, elements: int = 100) -> ImpactScales:
    """Scales of the scene's impact from a coarse row of springs, good to about 1/elements^2, in milliseconds.

    Raises NotReached when the coarse row does not come to an end.
    """
    problem = problem_of(scene)
    track = coarse(problem, scene.end_time, elements)
    inside = track.approach + track.rebound
    highest, deepest = max(inside, key=_force), max(inside, key=_depth)
    last = inside[-1]
    left = track.end is End.SEPARATED
    return ImpactScales(
        contact_radius=max(instant.edge for instant in inside),
        peak_depth=deepest.depth,
        peak_force=highest.force,
        peak_time=highest.time,
        turn_time=track.approach[-1].time,
        end=last.time,
        duration=last.time if left else None,
        restitution=-last.velocity / scene.velocity if left else None,
    )


def problem_of(scene: Scene) -> Problem:
    """What the row of springs needs of a scene."""
    return Problem(scene.profile, scene.contact_modulus, scene.mass, scene.velocity, scene.model.gravity)


def coarse(problem: Problem, end_time: float, elements: int) -> Track:
    """One march whose steps follow the error that they make."""
    reach = _least_reach(problem)
    first = float(problem.shape.load_curve.depth(reach / elements)) / problem.velocity

    def pace(start: Instant) -> Adaptive:
        h = first if start.time == 0.0 else start.time / elements
        return Adaptive(min(h, end_time), elements, max(reach, start.edge), problem.velocity)

    return march(problem, end_time, pace, MOST_STEPS)


def _least_reach(problem: Problem) -> float:
    """A contact radius that the impact surely exceeds half of, m: that of the stiffest of its answers.

    A dashpot alone stops the striker at depth (3 m v/(4 eta sqrt(R)))^(2/3); it counts like a spring whose Hertz
    contact lasts as long as eta over its stiffness.
    """
    modulus = problem.modulus
    mass, velocity = problem.mass, problem.velocity
    reaches = [problem.shape.hertz_impact(modulus.glassy, mass, velocity).contact_radius] if modulus.glassy else []
    if modulus.viscosity:
        unit = problem.shape.hertz_impact(modulus.viscosity, mass, velocity).duration
        spring = modulus.viscosity / unit ** (5.0 / 3.0)
        reaches.append(problem.shape.hertz_impact(spring, mass, velocity).contact_radius)
    return min(reaches)


def _force(instant: Instant) -> float:
    return instant.force


def _depth(instant: Instant) -> float:
    return instant.depth
