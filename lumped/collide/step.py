"""One step of the motion: the accelerations at all Radau points at once, by Newton's method."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumped.collide.bodies import TINY, Bodies, PointLaw, Stage, State
from lumped.collide.nodes import STAGES as STAGES
from lumped.collide.nodes import radau

Array = NDArray[np.float64]
NODES = radau(STAGES)
ITERATIONS = 12
# Newton's last correction, relative to the largest acceleration: the next one would be its square.
SMALL = 1e-9


class Step(NamedTuple):
    """One step from `start`, `length` s long; accelerations, rates, depths, forces at the Radau points, shape (s,)."""

    start: State
    length: float
    acceleration: Array
    rate: Array
    depth: Array
    force: Array
    end: State
    iterations: int


def solved(law: PointLaw, stage: Stage, bodies: Bodies, start: State, length: float, guess: Array) -> Step | None:
    """The step whose accelerations satisfy m a + F(depth, rate) = m g at every point; None without convergence."""
    once, twice = length * NODES.once, length**2 * NODES.twice
    ballistic = start.depth + length * start.rate * NODES.points
    acceleration, seen = guess, law.within(start, length)
    for iteration in range(1, ITERATIONS + 1):
        rate = start.rate + once @ acceleration
        depth = ballistic + twice @ acceleration
        pressed = np.maximum(depth, TINY)
        excess = acceleration - bodies.gravity + seen.force(pressed, rate, stage) / bodies.mass
        stiffness, damping = seen.tangents(pressed, rate, stage)
        over_depth = stiffness * (depth > 0.0)
        bent = over_depth @ twice if over_depth.ndim == 2 else (over_depth * twice.T).T
        jacobian = (bent + (damping * once.T).T) / bodies.mass
        jacobian.flat[:: STAGES + 1] += 1.0
        correction = np.linalg.solve(jacobian, excess)
        acceleration = acceleration - correction
        if not np.isfinite(correction).all():
            return None
        if np.abs(correction).max() <= SMALL * np.abs(acceleration).max():
            return _finished(seen, stage, bodies, start, length, acceleration, iteration)
    return None


def _finished(
    law: PointLaw, stage: Stage, bodies: Bodies, start: State, length: float, acceleration: Array, iterations: int
) -> Step:
    rate = start.rate + length * (NODES.once @ acceleration)
    depth = start.depth + length * (start.rate * NODES.points + length * (NODES.twice @ acceleration))
    pressed = np.maximum(depth, TINY)
    lost = start.lost + length * float(NODES.weights @ (law.lost(pressed, rate, stage) * rate))
    end = State(float(depth[-1]), float(rate[-1]), lost, law.remembered(pressed))
    force = bodies.mass * (bodies.gravity - acceleration)
    return Step(start, length, acceleration, rate, depth, force, end, iterations)


def roughness(step: Step) -> float:
    """What the last Legendre terms of the acceleration are worth in rate over the step, m/s."""
    last = NODES.series[-2:] @ step.acceleration
    return step.length * float(np.abs(last).max())
