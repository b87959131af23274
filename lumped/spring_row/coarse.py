"""One march of the row of springs at its own pace: quick, good to about 1/elements^2."""

from __future__ import annotations

from lumped.scales import stiffest_impact
from lumped.scene import Scene
from lumped.spring_row.march import Track, march
from lumped.spring_row.pace import Adaptive
from lumped.spring_row.row import Problem

MOST_STEPS = 10_000


def problem_of(scene: Scene) -> Problem:
    """What the row of springs needs of a scene."""
    return Problem(scene.profile, scene.contact_modulus, scene.reduced_mass, scene.velocity, scene.gravity)


def coarse(problem: Problem, end_time: float, elements: int) -> Track:
    """One march with steps by their error and by the travel of the edge, 1/elements. Raises NotReached."""
    return march(problem, end_time, pace_of(problem, end_time, elements), MOST_STEPS)


def pace_of(problem: Problem, end_time: float, elements: int) -> Adaptive:
    """Its pace."""
    reach = stiffest_impact(problem.shape, problem.modulus, problem.mass, problem.velocity).contact_radius
    first = float(problem.shape.load_curve.depth(reach / elements)) / problem.velocity

    return Adaptive(min(first, end_time), elements, reach, problem.velocity)
