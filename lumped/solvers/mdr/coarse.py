"""One march of the row of springs at its own pace: quick, good to about 1/elements^2."""

from __future__ import annotations

from lumped.result.ending import End
from lumped.scene.scales import stiffest_impact
from lumped.scene.scene import Scene
from lumped.solvers.mdr.march import RowTrack, march
from lumped.solvers.mdr.pace import Adaptive
from lumped.solvers.mdr.row import RowProblem

MOST_STEPS = 10_000
# An end time is near a turn that comes before so many times it, and not more than so many steps before it.
FURTHER, NEAR = 1.2, 1.5


def problem_of(scene: Scene) -> RowProblem:
    """What the row of springs needs of a scene."""
    return RowProblem(scene.profile, scene.contact_modulus, scene.reduced_mass, scene.velocity, scene.gravity)


def coarse(problem: RowProblem, end_time: float, elements: int) -> RowTrack:
    """One march with steps by their error and by the travel of the edge, 1/elements. Raises NotReached."""
    return march(problem, end_time, pace_of(problem, end_time, elements), MOST_STEPS)


def coarse_beyond(problem: RowProblem, end_time: float, elements: int) -> tuple[RowTrack, float]:
    """One march with when it stops, s: at the end time or, where that lies within some steps of the turn, beyond both.

    Finer marches than this turn at other times: if all go further none of them is cut short of the turn, or by it.
    Raises NotReached.
    """
    track = coarse(problem, end_time, elements)
    if track.end is not End.TIME:
        return track, end_time
    further = coarse(problem, FURTHER * end_time, elements)
    if not further.rebound:
        return track, end_time
    *_, before, last, turn = (instant.time for instant in further.approach)
    later = max(end_time, turn) + 2.0 * NEAR * (last - before)
    if end_time > turn + NEAR * (last - before):
        return track, end_time
    beyond = coarse(problem, later, elements)
    return (beyond, later) if beyond.end is End.TIME else (track, end_time)


def pace_of(problem: RowProblem, end_time: float, elements: int) -> Adaptive:
    """Its pace."""
    reach = stiffest_impact(problem.shape, problem.modulus, problem.mass, problem.velocity).contact_radius
    first = float(problem.shape.load_curve.depth(reach / elements)) / problem.velocity

    return Adaptive(min(first, end_time), elements, reach, problem.velocity)
