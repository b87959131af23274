"""How far a march is from the motion: the defect of its polynomials, followed by the linearised motion.

The polynomials of a step satisfy m a + F(depth, rate) = m g at its nodes and miss it by a defect between them. What
depth and rate still lack, delta and epsilon, solves, to first order,

    delta' = epsilon + (rate - depth'),    m epsilon' = -(K delta + C epsilon) + (m g - F - m a),

K and C the tangents of the law: here by collocation at more nodes of the same steps, all steps of a phase at once.
Defect correction: Stetter 1978, doi 10.1007/BF01432879. A force without jumps carries the deviation through turns and
corners as it is; only what a law keeps of the place where it turned is corrected too.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from lumped.solvers.point.bodies import TINY, Bodies, PointLaw, Stage
from lumped.solvers.point.contact import Contact, following
from lumped.solvers.point.nodes import STAGES, paced, radau
from lumped.solvers.point.phase import Phase
from lumped.solvers.point.track import Row, Track, legendre_terms

Array = NDArray[np.float64]
NODES = radau(12)


class Deviation(NamedTuple):
    """One phase at the nodes of its n steps, all of shape (n, S): times and weights in time, s, depth, rate and force
    of the march, and what each of the three lacks, SI.
    """

    times: Array
    weights: Array
    depth: Array
    rate: Array
    force: Array
    lacking_depth: Array
    lacking_rate: Array
    lacking_force: Array


def deviations(track: Track, bodies: Bodies, one: Contact) -> list[Deviation]:
    """Those of the phases of the first contact of a track, whose law remembers nothing of its path but turns."""
    found: list[Deviation] = []
    start, stage = (0.0, 0.0), one.phases[0].stage
    for phase in one.phases:
        found.append(_of(track.law, bodies, phase, track.row(phase), start, stage))
        start = float(found[-1].lacking_depth[-1, -1]), float(found[-1].lacking_rate[-1, -1])
        if phase.event == "turn":
            stage = following(track.law, stage, phase.last.end.depth + start[0])
    return found


def _of(law: PointLaw, bodies: Bodies, phase: Phase, row: Row, start: tuple[float, float], stage: Stage) -> Deviation:
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
    return Deviation(times, passing * NODES.weights, depth, rate, force, lacking_depth, lacking_rate, lacking_force)


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
    x = 2.0 * NODES.places - 1.0
    slopes = np.array([2.0 * legendre.legval(x, legendre.legder(row)) for row in np.eye(STAGES + 1)])
    return legendre_terms(x), slopes
