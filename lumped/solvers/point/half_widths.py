"""What the deviations of a march are worth in its outcome: an estimate of every error, to first order."""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from lumped.result.ending import AT_REST, End
from lumped.solvers.point.bodies import Bodies
from lumped.solvers.point.contact import leaving
from lumped.solvers.point.deviation import NODES, Deviation, deviations
from lumped.solvers.point.outcome import Outcome
from lumped.solvers.point.track import Track

Array = NDArray[np.float64]
# Estimates are to first order, and tell the largest of a smooth error from its values at some points.
SAFETY = 3.0
UNSURE = 0.2
# Rounding of depths and rates along a march, relative to the largest; of times; of forces; of the time of a flat peak.
ROUNDING, ROUNDING_OF_TIME, ROUNDING_OF_FORCE, ROUNDING_OF_PEAK = 1e-14, 3e-14, 1e-13, 3e-9


class HalfWidths(NamedTuple):
    """Absolute, SI, of the quantities of a Result by their names; `force`: the largest over the history."""

    force: float
    history_l2: float
    peak_force: float
    peak_time: float
    peak_depth: float
    duration: float
    restitution: float
    impulse: float


def half_widths(track: Track, bodies: Bodies, exit_rule: str, outcome: Outcome, impulse: float) -> HalfWidths:
    """Of the first contact of a track, whose law remembers nothing of its path but turns, and of its impulse, N s."""
    one = track.motion.contacts[0]
    found = deviations(track, bodies, one)
    rest = AT_REST if one.end is End.REST else 0.0
    rounding, of_force = ROUNDING + rest, ROUNDING_OF_FORCE + rest
    highest = max(float(np.abs(part.force).max()) for part in found)
    peak, peak_time = _peak(found, outcome.peak_time)
    duration, rate = _end(track, bodies, exit_rule, found[-1])
    restitution = rate / bodies.velocity + rounding
    passed = bodies.mass * (bodies.velocity * restitution + abs(bodies.gravity) * duration)
    return HalfWidths(
        force=SAFETY * max(float(np.abs(part.lacking_force).max()) for part in found) + of_force * highest,
        history_l2=SAFETY * _l2(found) + of_force,
        peak_force=SAFETY * peak + of_force * outcome.peak_force,
        peak_time=SAFETY * peak_time + ROUNDING_OF_PEAK * outcome.peak_time,
        peak_depth=SAFETY * _deepest(found) + rounding * one.deepest,
        duration=duration,
        restitution=restitution,
        impulse=passed + rounding * abs(impulse),
    )


def _end(track: Track, bodies: Bodies, exit_rule: str, last: Deviation) -> tuple[float, float]:
    """By how much a contact may end at another time, s, and with another rate, m/s, rounding of time included."""
    one = track.motion.contacts[0]
    depth, rate, force = (float(part[-1, -1]) for part in last[5:])
    if one.end is not End.SEPARATED:
        return 0.0, SAFETY * abs(rate)
    event, step = leaving(track.law, exit_rule), one.phases[-1].last
    unmet, around = (depth, step.depth) if event.surfaces else (force, step.force)
    later = -unmet / event.slope(step)
    noise = ROUNDING * float(np.abs(around / event.slope(step)).max()) + ROUNDING_OF_TIME * one.end_time
    acceleration = bodies.gravity - float(step.force[-1]) / bodies.mass
    return SAFETY * abs(later) + noise, SAFETY * abs(rate + acceleration * later) + abs(acceleration) * noise


def _deepest(found: list[Deviation]) -> float:
    """What the largest depth lacks, m."""
    part = max(found, key=lambda part: float(part.depth.max()))
    return abs(float(part.lacking_depth.flat[part.depth.argmax()]))


def _peak(found: list[Deviation], time: float) -> tuple[float, float]:
    """What the highest force lacks around `time`, N, and by how much its time errs there, s."""
    part = next((part for part in found if time <= part.times[-1, -1]), found[-1])
    i = min(int(np.searchsorted(part.times[:, -1], time)), part.times.shape[0] - 1)
    lacking, pace = part.lacking_force[i], part.weights[i] / NODES.weights
    begun = part.times[i, -1] - part.weights[i].sum()
    place = float(np.interp(time, np.append(begun, part.times[i]), np.append(0.0, NODES.places)))
    there = legendre.legval(2.0 * place - 1.0, NODES.series @ lacking)
    # Steps know their ends better than what is between: there the estimate may be wrong by a share of the largest.
    height = abs(float(there)) + UNSURE * place * (1.0 - place) * float(np.abs(lacking).max())
    tilt = np.abs(_slopes() @ lacking / pace).max()
    bent = _slopes() @ (_slopes() @ part.force[i] / pace) / pace
    curvature = abs(float(bent[np.abs(part.times[i] - time).argmin()]))
    whole = float(found[-1].times[-1, -1])
    return height, min(float(tilt) / curvature, whole) if curvature else whole


def _l2(found: list[Deviation]) -> float:
    """The norm of what the force lacks over that of the force."""
    lacking = sum(float((part.weights * part.lacking_force**2).sum()) for part in found)
    whole = sum(float((part.weights * part.force**2).sum()) for part in found)
    return math.sqrt(lacking / whole) if whole else 0.0


@cache
def _slopes() -> Array:
    """The slopes over the place, at the nodes, of what has these values there, shape (S, S)."""
    x = 2.0 * NODES.places - 1.0
    rows = [2.0 * legendre.legval(x, legendre.legder(row)) for row in np.eye(x.size)]
    return np.array(rows).T @ NODES.series
