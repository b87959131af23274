"""Error bars of a march: how far it is from the motion, to first order, and what that changes of every quantity.

The polynomials of a step satisfy m a + F(depth, rate) = m g at its nodes and miss it by a defect between them. What
depth and rate still lack, delta and epsilon, solves, to first order,

    delta' = epsilon + (rate - depth'),    m epsilon' = -(K delta + C epsilon) + (m g - F - m a),

K and C the tangents of the law: here by collocation at more nodes of the same steps, all steps of a phase at once.
Defect correction: Stetter 1978, doi 10.1007/BF01432879. A force without jumps carries the deviation through turns and
corners as it is; only what a law keeps of the place where it turned is corrected too.
"""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from lumped.numbers import Array, rounded_by_time
from lumped.result.history import AT_REST, End
from lumped.solvers.point.bodies import TINY, Bodies, PointLaw, Stage
from lumped.solvers.point.contact import Contact, following, leaving
from lumped.solvers.point.phase import RATE, PointPhase
from lumped.solvers.point.track import Outcome, PointRow, PointTrack, legendre_terms
from lumped.solvers.radau import STAGES, paced, radau

# Estimates are to first order, and tell the largest of a smooth error from its values at some points.
SAFETY = 3.0
UNSURE = 0.2  # safety: share of the largest lack that is added between a step's ends, where the estimate may be wrong
# Rounding of depths and rates along a march, relative to the largest; of times; of forces; of the time of a flat peak.
ROUNDING, ROUNDING_OF_TIME, ROUNDING_OF_FORCE, ROUNDING_OF_PEAK = 1e-14, 3e-14, 1e-13, 3e-9
ROUNDING_OF_DEPTH = 1e-15  # of the depth at which a law is asked
NODES = radau(12)


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


def half_widths(track: PointTrack, bodies: Bodies, exit_rule: str, outcome: Outcome, impulse: float) -> HalfWidths:
    """Of the first contact of a track, whose law remembers nothing of its path but turns, and of its impulse, N s."""
    one = track.motion.contacts[0]
    found = deviations(track, bodies, one)
    rest = AT_REST if one.end is End.REST else 0.0
    rounding, of_force = ROUNDING + rest, ROUNDING_OF_FORCE + rest
    highest = max(float(np.abs(part.force).max()) for part in found)
    peak, peak_time, reach = _peak(found, outcome.peak_time)
    duration, rate = _end(track, bodies, exit_rule, found[-1])
    fastest = max(bodies.velocity, *(float(np.abs(part.rate).max()) for part in found))
    restitution = (rate + rounding * fastest) / bodies.velocity
    passed = bodies.mass * (bodies.velocity * restitution + abs(bodies.gravity) * duration)
    return HalfWidths(
        force=SAFETY * max(float(np.abs(part.lacking_force).max()) for part in found)
        + max(of_force * highest, *(float(part.rounded_force.max()) for part in found)),
        history_l2=SAFETY * _l2(found) + max(of_force, _norm(found, [part.rounded_force for part in found])),
        peak_force=SAFETY * peak + of_force * outcome.peak_force,
        peak_time=SAFETY * peak_time + ROUNDING_OF_PEAK * max(outcome.peak_time, reach),
        peak_depth=SAFETY * _deepest(found) + rounding * one.deepest,
        duration=duration,
        restitution=restitution,
        impulse=passed + rounding * abs(impulse),
    )


def _end(track: PointTrack, bodies: Bodies, exit_rule: str, last: Deviation) -> tuple[float, float]:
    """By how much a contact may end at another time, s, and with another rate, m/s, rounding of time included.

    A weight may press far deeper than the velocity at touch would, and what is rounded there is carried to the end.
    """
    one = track.motion.contacts[0]
    lacking = [float(part[-1, -1]) for part in last[5:8]]
    rate = lacking[RATE]
    if one.end is not End.SEPARATED:
        return 0.0, SAFETY * abs(rate)
    phase, step = one.phases[-1], one.phases[-1].last
    event = leaving(track.law, phase.stage, exit_rule, bodies)[phase.event or "exit"]
    later = -lacking[event.told_by] / event.slope(step)
    carried = [step for phase in one.phases for step in phase.steps] if bodies.gravity > 0.0 else [step]
    around = max(float(np.abs(event.value(step)).max()) for step in carried)
    # a force that ends flat is not left at its end to the last digit
    short = SAFETY * abs(float(event.value(step)[-1]))
    noise = (ROUNDING * around + short) / abs(event.slope(step)) + ROUNDING_OF_TIME * one.end_time
    acceleration = bodies.gravity - float(step.force[-1]) / bodies.mass
    return SAFETY * abs(later) + noise, SAFETY * abs(rate + acceleration * later) + abs(acceleration) * noise


def _deepest(found: list[Deviation]) -> float:
    """What the largest depth lacks, m."""
    part = max(found, key=lambda part: float(part.depth.max()))
    return abs(float(part.lacking_depth.flat[part.depth.argmax()]))


def _peak(found: list[Deviation], time: float) -> tuple[float, float, float]:
    """What the highest force lacks around `time`, N, by how much its time errs there, s, and how far rounding reaches.

    That is the time, s, of which ROUNDING_OF_PEAK is lost: of half a sine that of its peak; of a flatter peak longer,
    as it is less curved. What is lost is no longer than the whole contact.
    """
    part = next((part for part in found if time <= part.times[-1, -1]), found[-1])
    i = int(np.searchsorted(part.times[:-1, -1], time))
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
    if not curvature:
        return height, whole, time
    flat = float(part.force[i].max()) / curvature * (0.5 * np.pi) ** 2 / time if time else 0.0
    return height, min(float(tilt) / curvature, whole), min(flat, whole / ROUNDING_OF_PEAK)


def _l2(found: list[Deviation]) -> float:
    """The norm of what the force lacks over that of the force."""
    return _norm(found, [part.lacking_force for part in found])


def _norm(found: list[Deviation], missed: list[Array]) -> float:
    """The norm of what is missed of the force over that of the force."""
    lacking = sum(float((part.weights * one**2).sum()) for part, one in zip(found, missed, strict=True))
    whole = sum(float((part.weights * part.force**2).sum()) for part in found)
    return math.sqrt(lacking / whole) if whole else 0.0


@cache
def _slopes() -> Array:
    """The slopes over the place, at the nodes, of what has these values there, shape (S, S)."""
    return np.asarray(_rises(NODES.points.size).T @ NODES.series)


def _rises(count: int) -> Array:
    """The slopes over the place, at the nodes, of the first Legendre polynomials, shape (count, S)."""
    x = 2.0 * NODES.places - 1.0
    return np.array([2.0 * legendre.legval(x, legendre.legder(row)) for row in np.eye(count)])


class Deviation(NamedTuple):
    """One phase at the nodes of its n steps, all of shape (n, S): times and weights in time, s, depth, rate and force
    of the march, and what each of the three lacks, SI; and by how much rounding of times and depths shifts the force.
    """

    times: Array
    weights: Array
    depth: Array
    rate: Array
    force: Array
    lacking_depth: Array
    lacking_rate: Array
    lacking_force: Array
    rounded_force: Array


def deviations(track: PointTrack, bodies: Bodies, one: Contact) -> list[Deviation]:
    """Those of the phases of the first contact of a track, whose law remembers nothing of its path but turns."""
    found: list[Deviation] = []
    start, stage = (0.0, 0.0), one.phases[0].stage
    for phase in one.phases:
        found.append(_of(track.law, bodies, phase, track.row(phase), start, stage))
        start = float(found[-1].lacking_depth[-1, -1]), float(found[-1].lacking_rate[-1, -1])
        if phase.event == "turn":
            stage = following(track.law, stage, phase.last.end.depth + start[0])
    return found


def _of(
    law: PointLaw, bodies: Bodies, phase: PointPhase, row: PointRow, start: tuple[float, float], stage: Stage
) -> Deviation:
    """That of one phase which begins with the deviations `start`; `stage` as it should be."""
    terms, slopes = _terms()
    share, pace = paced(NODES.places, *(what[:, None] for what in (row.powers, row.begun, row.mirrored)))
    depth, rate = (row.series[:, j] @ terms for j in range(2))
    passing = row.lengths[:, None] * pace
    push, pressed = passing / bodies.mass, np.maximum(depth, TINY)
    force = law.force(pressed, rate, phase.stage)
    stiffness, damping = law.tangents(pressed, rate, phase.stage)
    stiffness = stiffness * (depth > 0.0)
    moved = law.force(pressed, rate, stage) - force if stage.kept else 0.0
    drift = passing * rate - row.series[:, 0] @ slopes
    defect = passing * bodies.gravity - push * (force + moved) - row.series[:, 1] @ slopes
    pushed = NODES.once * (push * stiffness)[:, None, :]
    damped = NODES.once * (push * damping)[:, None, :]
    passed = NODES.once * passing[:, None, :]
    drifted = drift @ NODES.once.T
    # of the defect, of a deviation in depth and of one in rate at the start of each step
    right = np.stack([defect @ NODES.once.T, -pushed.sum(axis=2), np.ones_like(depth)], axis=2)
    right[:, :, 0] -= (pushed @ drifted[:, :, None])[:, :, 0]
    rates = np.linalg.solve(pushed @ passed + damped + np.eye(NODES.points.size), right)
    depths = passed @ rates
    depths[:, :, 0] += drifted
    depths[:, :, 1] += 1.0
    lacking_depth, lacking_rate = _in_a_row(depths, rates, start)
    lacking_force = stiffness * lacking_depth + damping * lacking_rate + moved
    times = row.starts[:, None] + row.lengths[:, None] * share
    late = np.append(0.0, rounded_by_time(times.ravel(), force.ravel())).reshape(times.shape)
    rounded = np.maximum(late, ROUNDING_OF_DEPTH * np.abs(stiffness) * depth)
    weights = passing * NODES.weights
    return Deviation(times, weights, depth, rate, force, lacking_depth, lacking_rate, lacking_force, rounded)


def _in_a_row(depths: Array, rates: Array, start: tuple[float, float]) -> tuple[Array, Array]:
    """The deviations at all nodes, shape (n, S): each step begins with those at the end of the one before."""
    responses, state, found = np.stack([depths, rates]), np.array([1.0, *start]), []
    for i in range(responses.shape[1]):
        found.append(responses[:, i] @ state)
        state[1:] = found[-1][:, -1]
    lacking_depth, lacking_rate = np.stack(found, axis=1)
    return lacking_depth, lacking_rate


@cache
def _terms() -> tuple[Array, Array]:
    """P_0 to P_s and their slopes over the place, shape (s + 1, S)."""
    return legendre_terms(2.0 * NODES.places - 1.0), _rises(STAGES + 1)
