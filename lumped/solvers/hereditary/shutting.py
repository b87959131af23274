"""The last piece of the correspondence law's rebound, over q = -sqrt(T - t): what is sought is T, the time of F = 0."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumped.solvers.hereditary.approach import DEPTH, FORCE, VELOCITY
from lumped.solvers.hereditary.march import Settings, tail
from lumped.solvers.hereditary.motion import PieceMotion
from lumped.solvers.hereditary.path import Path
from lumped.solvers.hereditary.problem import Hereditary

Array = NDArray[np.float64]
TRIES = 12
# Loads as near to each other tell no slope; a relative change of the duration that is noise once it falls no more.
SAME, ROUNDED = 1e-11, 1e-7
# A duration is near that changes by no more than this share.
NEAR = 0.1


class Guess(NamedTuple):
    """A duration, the accelerations at the nodes, and how steeply F falls with the load y, 0 where not known."""

    duration: float
    accelerations: Array
    steep: float = 0.0

    @classmethod
    def of(cls, problem: Hereditary, duration: float, over: Path, steep: float, settings: Settings) -> Guess:
        """From a piece over q that was found, and ends as this one of another duration."""
        places = -(duration**0.5) * (1.0 - settings.table.nodes)
        return cls(duration, problem.gravity - over.value(FORCE, places), steep)


class Shut(NamedTuple):
    """A last piece over q, its duration, dF/dy there, all Newton steps, and whether it errs by no more than allowed."""

    path: Path
    duration: float
    steep: float
    steps: int
    fits: bool


def shut(
    problem: Hereditary, state: Array, start: Guess, settings: Settings, close: float, allowed: float
) -> Shut | None:
    """The piece from a state that ends with F = 0: the duration by secants, to the relative change `close`.

    One that will err by more than `allowed` is not sought any closer, and is None where its end is not near yet, as it
    is where Newton's steps fail.
    """
    (duration, a, steep), steps, missed = start, 0, math.inf
    power, unit = _power(problem, state)
    steep, before = steep or unit * _mean_modulus(problem, duration), None
    for _ in range(TRIES):
        piece = PieceMotion.to_end(problem, settings.table, duration).piece(state, a)
        if piece is None:
            return None
        steps += piece.steps
        now, error = _Fallen.of(piece.values[:, -1], power), tail(piece.values[FORCE], settings.table)
        if before:
            steep = now.steep(before) or steep
        change = now.lasts(steep, power)
        longer = min(max(1.0 + change / duration, 0.5), 2.0)
        fits = error * longer**settings.points <= allowed  # a tail falls with the length
        rounded = max(abs(change), missed) <= ROUNDED * duration and abs(change) > 0.5 * missed
        if not fits and abs(change) > NEAR * duration:
            return None
        if abs(change) <= close * duration or rounded or not fits:
            path = Path.of([-(duration**0.5), 0.0], [piece.values], settings.table)
            return Shut(path, duration if fits else longer * duration, steep, steps, fits)
        before, missed = now, abs(change) if before else math.inf
        duration, a = longer * duration, problem.gravity - piece.values[FORCE, 1:]
    return None


class _Fallen(NamedTuple):
    """Depth, velocity and force after a try, and the load of that depth by its power, in a unit of its own."""

    depth: float
    velocity: float
    force: float
    load: float

    @classmethod
    def of(cls, state: Array, power: float) -> _Fallen:
        """At a state; the load is odd, as it is of the problem."""
        depth, velocity, force = (float(state[field]) for field in (DEPTH, VELOCITY, FORCE))
        return cls(depth, velocity, force, math.copysign(abs(depth) ** power, depth))

    def steep(self, before: _Fallen) -> float:
        """The secant's dF/dy; 0 where it tells none, or one that does not rise."""
        rise = self.load - before.load
        return max((self.force - before.force) / rise, 0.0) if abs(rise) > SAME * abs(self.load) else 0.0

    def lasts(self, steep: float, power: float) -> float:
        """How much longer F > 0 lasts: on a straight line over the load. Infinite where that does not fall."""
        if not self.load:
            return 0.0
        if self.velocity >= 0.0:
            return math.copysign(math.inf, self.force)
        load = self.load - self.force / steep
        return (math.copysign(abs(load) ** (1.0 / power), load) - self.depth) / self.velocity


def _power(problem: Hereditary, state: Array) -> tuple[float, float]:
    """Power and unit of the load y = unit depth^power around a state; F falls about straight with y, not with depth."""
    load, slope = (float(value[0]) for value in problem.loads(state[:1]))
    depth = float(state[DEPTH])
    power = slope * depth / load
    return power, abs(load) / abs(depth) ** power  # the load is odd, of a surface that is drawn out too


def _mean_modulus(problem: Hereditary, duration: float) -> float:
    """The mean of E over ages up to a duration: F falls by as much with the load, if this falls evenly."""
    modulus, ages = problem.modulus, duration * problem.rates
    mean = modulus.equilibrium - float(problem.stiffnesses @ (np.expm1(-ages) / ages))
    return mean + modulus.viscosity / duration
