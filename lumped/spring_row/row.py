"""The row of springs and one step of it, in contact that grows or shrinks.

Over a step the acceleration is linear in time, so the new acceleration is the one unknown, found by Newton
steps on a = gravity - F/m. The springs stand where the edge of contact stood at the end of each step of the
approach: none is touched within a step, and they crowd where the contact needs them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumped.errors import NotReached
from lumped.materials import Relaxation
from lumped.shapes import Shape
from lumped.spring_row.edge import Growing, Shrinking
from lumped.spring_row.memory import Ageing, ageing

Array = NDArray[np.float64]
NEWTON_STEPS = 60
# Newton's last correction; what is left after it is smaller by another power of the edge cell.
CONVERGED, ROUNDING = 1e-12, 2e-15
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
    """A step not yet taken: where it leads, the force per length at the axis, how z falls and rises."""

    now: Instant
    axis: float
    decays: list[float]
    rises: list[float]


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
        ageing, held = self._aged(now, h)
        n = self.count
        return self._try(now, h, ageing, held, Growing(self.curve, self.x[:n], self.weights[:n], held))

    def try_shrinking(self, now: Instant, h: float) -> Trial:
        """One step of length h, s, of the rebound, not yet taken. Raises NotReached."""
        ageing, held = self._aged(now, h)
        return self._try(now, h, ageing, held, Shrinking(self.x[: self.count], held))

    def grow(self, trial: Trial) -> None:
        """Take a step of the approach: the springs age, and one without force joins at the new edge."""
        self._age(trial)
        n = self.count
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
        """Take a step of the rebound: the springs age, and those beyond the edge leave.

        The next two stay in the arrays, without force, for the edge to be interpolated.
        """
        self._age(trial)
        self.count = min(self.count, int(self.x[: self.count].searchsorted(trial.now.edge)) + 2)

    def _aged(self, now: Instant, h: float) -> tuple[Ageing, Array]:
        """How the springs age, and what each then carries of itself."""
        aged = ageing(self.problem.modulus, h, now.velocity, now.acceleration)
        return aged, np.dot(aged.decays, self.z[:, : self.count]) - self.rest[: self.count]

    def _age(self, trial: Trial) -> None:
        z = self.z[:, : self.count]
        z *= np.array(trial.decays)[:, None]
        z += np.array(trial.rises)[:, None]

    def _try(self, now: Instant, h: float, aged: Ageing, held: Array, measure: Growing | Shrinking) -> Trial:
        """Newton steps on a = gravity - F/m for the acceleration `a` at the end of the step."""
        modulus, mass = self.problem.modulus, self.problem.mass
        common, change = sum(aged.increments), sum(aged.changes)
        yielding = 2.0 / mass * (modulus.equilibrium * h * h / 6.0 + change + 0.5 * modulus.viscosity * h)
        small = CONVERGED * (abs(now.acceleration) + 1e-3 * abs(now.velocity) / h)
        a = now.acceleration
        for _ in range(NEWTON_STEPS):
            velocity = now.velocity + 0.5 * h * (now.acceleration + a)
            depth = now.depth + h * (now.velocity + h * (2.0 * now.acceleration + a) / 6.0)
            viscous = modulus.viscosity * velocity
            lift = modulus.equilibrium * depth + common + change * (a - now.acceleration) + viscous
            half, edge = measure(lift, depth, viscous)
            give = 1.0 + yielding * edge
            correction = (a - self.problem.gravity + 2.0 * half / mass) / give
            a -= correction
            # The force may be a small difference of large terms: then their rounding is all that is left.
            terms = modulus.equilibrium * abs(depth) + abs(common) + abs(viscous)
            if abs(correction) <= small + CONVERGED * abs(a) + ROUNDING * terms * edge / (mass * give):
                instant = Instant(now.time + h, depth, velocity, a, 2.0 * half, edge)
                return Trial(instant, float(held[0]) + lift, aged.decays, aged.rises(a - now.acceleration))
        raise NotReached("the force within one step of the spring row did not converge")

    def _extend(self) -> None:
        """Room for as many springs again."""
        self.x, self.weights, self.rest = (np.append(c, np.zeros_like(c)) for c in (self.x, self.weights, self.rest))
        self.z = np.hstack([self.z, np.zeros_like(self.z)])
