"""The row of springs and one step of it, in contact that grows or shrinks.

Over a step the acceleration is linear in time, so the new acceleration is the one unknown, found by Newton steps on
a = gravity - F/m. The springs stand where the edge of contact stood at the end of each step of the approach: none is
touched within a step, and they crowd where the contact needs them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumped.errors import NotReached
from lumped.materials import Relaxation
from lumped.shapes import Shape
from lumped.spring_row import memory
from lumped.spring_row.edge import Growing, Shrinking

Array = NDArray[np.float64]
NEWTON_STEPS = 60
FIRST_SPRINGS = 256


@dataclass(frozen=True)
class Problem:
    """Profile, E*(t) in Pa, mass in kg, velocity at touch in m/s, gravity in m/s2."""

    shape: Shape
    modulus: Relaxation
    mass: float
    velocity: float
    gravity: float

    @property
    def is_fluid(self) -> bool:
        """Whether nothing is left of a stress after a long time."""
        return self.modulus.equilibrium == 0.0


class Instant(NamedTuple):
    """s, m, m/s, m/s2, N, m: the motion, the force and the edge of contact at one time."""

    time: float
    depth: float
    velocity: float
    acceleration: float
    force: float
    edge: float


class Trial(NamedTuple):
    """A step not yet taken: where it leads, the force per length at the axis there, and the springs' new z."""

    now: Instant
    axis: float
    state: Array


class Row:
    """Springs at `x`, ascending from the axis; `z` holds one row for every term of the relaxation series.

    `rest` is equilibrium modulus times g(x); `weights` are those of the trapezoid over the springs.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.curve = problem.shape.load_curve
        self.count = 1
        self.x = np.zeros(FIRST_SPRINGS)
        self.weights = np.zeros(FIRST_SPRINGS)
        self.rest = np.zeros(FIRST_SPRINGS)
        self.z = np.zeros((len(problem.modulus.moduli), FIRST_SPRINGS))

    def try_growing(self, now: Instant, h: float) -> Trial:
        """One step of length h, s, of the approach, not yet taken. Raises NotReached."""
        return self._try(now, h, growing=True)

    def try_shrinking(self, now: Instant, h: float) -> Trial:
        """One step of length h, s, of the rebound, not yet taken. Raises NotReached."""
        return self._try(now, h, growing=False)

    def grow(self, trial: Trial) -> None:
        """Take a step of the approach: the springs' new state, and a spring without force at the new edge."""
        n = self.count
        self.z[:, :n] = trial.state
        gap = trial.now.edge - self.x[n - 1]
        if gap <= 0.0:
            return
        if n == self.x.size:
            self._extend()
        self.x[n] = trial.now.edge
        self.rest[n] = self.problem.modulus.equilibrium * trial.now.depth
        self.weights[n - 1 : n + 1] += 0.5 * gap
        self.count = n + 1

    def shrink(self, trial: Trial) -> None:
        """Take a step of the rebound, and let go of the springs beyond the edge.

        The next two stay in the arrays, without force, for the edge to be interpolated.
        """
        self.z[:, : self.count] = trial.state
        self.count = min(self.count, int(self.x[: self.count].searchsorted(trial.now.edge)) + 2)

    def _try(self, now: Instant, h: float, growing: bool) -> Trial:
        modulus, n = self.problem.modulus, self.count
        decays, base, per_change = memory.step(modulus, h, now.velocity, now.acceleration)
        aged = self.z[:, :n] * np.array(decays)[:, None]
        held = aged.sum(axis=0) - self.rest[:n]
        measure = Growing(self.curve, self.x[:n], self.weights[:n], held) if growing else Shrinking(self.x[:n], held)
        common, change = sum(base), sum(per_change)
        yielding = 2.0 / self.problem.mass * (modulus.equilibrium * h * h / 6.0 + change + 0.5 * modulus.viscosity * h)
        small = 1e-14 * (abs(now.acceleration) + 1e-3 * abs(now.velocity) / h)
        a = now.acceleration
        for _ in range(NEWTON_STEPS):
            velocity = now.velocity + 0.5 * h * (now.acceleration + a)
            depth = now.depth + h * (now.velocity + h * (2.0 * now.acceleration + a) / 6.0)
            viscous = modulus.viscosity * velocity
            lift = modulus.equilibrium * depth + common + change * (a - now.acceleration) + viscous
            half, edge = measure(lift, depth, viscous)
            give = 1.0 + yielding * edge
            correction = (a - self.problem.gravity + 2.0 * half / self.problem.mass) / give
            a -= correction
            # The force may be a small difference of large terms: then their rounding is all that is left.
            terms = modulus.equilibrium * abs(depth) + abs(common) + abs(viscous)
            rounding = 2e-15 * terms * edge / (self.problem.mass * give)
            if abs(correction) <= small + rounding + 1e-14 * abs(a):
                state = aged + (np.array(base) + np.array(per_change) * (a - now.acceleration))[:, None]
                instant = Instant(now.time + h, depth, velocity, a, 2.0 * half, edge)
                return Trial(instant, float(held[0]) + lift, state)
        raise NotReached("the force within one step of the spring row did not converge")

    def _extend(self) -> None:
        """Room for as many springs again."""
        self.x, self.weights, self.rest = (np.append(column, np.zeros_like(column)) for column in
                                           (self.x, self.weights, self.rest))  # fmt: skip
        self.z = np.hstack([self.z, np.zeros_like(self.z)])
