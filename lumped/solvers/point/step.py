"""One step of the motion: the accelerations at all Radau points at once, by Newton's method."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dgesv

from lumped.solvers.point.bodies import TINY, Bodies, PointLaw, Stage, State, Step
from lumped.solvers.point.nodes import STAGES as STAGES
from lumped.solvers.point.nodes import Nodes, radau

Array = NDArray[np.float64]
NODES = radau(STAGES)
ITERATIONS = 12
# Newton's last correction times its ratio to the one before is more than what is left; relative to the largest gain
# and to the gain that would change the rate by as much as it is.
SMALL = 1e-11
# A correction as small as this is rounding.
ROUNDING = 1e-14


def solved(
    law: PointLaw, stage: Stage, bodies: Bodies, start: State, length: float, guess: Array, nodes: Nodes = NODES
) -> Step | None:
    """The step whose accelerations satisfy m a + F(depth, rate) = m g at every point; None without convergence."""
    once, twice = length * nodes.once, length**2 * nodes.twice
    ballistic = start.depth + length * start.rate * nodes.points
    pull, push = nodes.pace * bodies.gravity, nodes.pace / bodies.mass
    turning, bending = push[:, None] * once, push[:, None] * twice
    gain, seen, before = guess, law.within(start, length), 0.0
    for iteration in range(1, ITERATIONS + 1):
        rate = start.rate + once @ gain
        depth = ballistic + twice @ gain
        pressed = np.maximum(depth, TINY)
        excess = gain - pull + push * seen.force(pressed, rate, stage)
        stiffness, damping = seen.tangents(pressed, rate, stage)
        over_depth = stiffness * (depth > 0.0)
        jacobian = push[:, None] * (over_depth @ twice) if over_depth.ndim == 2 else over_depth[:, None] * bending
        jacobian += damping[:, None] * turning
        jacobian.flat[:: STAGES + 1] += 1.0
        correction = dgesv(jacobian, excess)[2]
        gain = gain - correction
        size = float(np.abs(correction).max())
        scale = abs(gain[0]) + abs(gain[-1]) + (abs(start.rate) + abs(rate[-1])) / length
        if not math.isfinite(size):
            return None
        if size <= ROUNDING * scale or size * size <= SMALL * scale * before:
            return _finished(seen, stage, bodies, start, length, nodes, gain, iteration)
        before = size
    return None


def _finished(
    law: PointLaw, stage: Stage, bodies: Bodies, start: State, length: float, nodes: Nodes, gain: Array, count: int
) -> Step:
    rate = start.rate + length * (nodes.once @ gain)
    depth = start.depth + length * (start.rate * nodes.points + length * (nodes.twice @ gain))
    pressed = np.maximum(depth, TINY)
    power = nodes.pace * law.lost(pressed, rate, stage) * rate
    lost = start.lost + length * float(nodes.weights @ power)
    end = State(float(depth[-1]), float(rate[-1]), lost, law.remembered(pressed))
    acceleration = gain
    if nodes.power > 1:
        acceleration = np.divide(gain, nodes.pace, out=np.full(STAGES, bodies.gravity), where=nodes.pace > 0.0)
    return Step(start, length, nodes, gain, rate, depth, bodies.mass * (bodies.gravity - acceleration), end, count)


def roughness(step: Step) -> float:
    """What the last Legendre terms of the gain are worth in rate over the step, m/s."""
    return step.length * float(np.abs(step.nodes.series[-2:] @ step.gain).max())
