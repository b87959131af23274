"""The row of springs: what is pressed now, and where the edge of contact has been.

Within a step the depth grows evenly, at the mean of the velocities at its ends: the time integral of Newton's law tells
this mean. Everything else follows in closed form, so the energy of mass, springs and dashpots is kept to rounding,
however long the steps are. The springs between two places of the edge count as one, with their mean profile.
"""

from __future__ import annotations

import math
from copy import copy
from dataclasses import dataclass
from typing import NamedTuple

from lumped.materials import Relaxation
from lumped.shapes import Shape
from lumped.solvers.mdr.memory import Fading
from lumped.solvers.mdr.springs import Springs, Values, none


@dataclass(frozen=True)
class RowProblem:
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


class Place(NamedTuple):
    """Where the edge was in the approach at a time, and what the spring at the axis carried then, per branch.

    `springs` is the one that stands for those touched in the step before, as it was then; `kept` as in Step.
    """

    time: float
    depth: float
    edge: float
    axis: Values
    springs: Springs
    kept: Values


class RowStep(NamedTuple):
    """A step not yet taken: where it leads, the springs pressed then, energies spent in dashpots and released in it, J.

    Of the motion whose velocity runs evenly from one end to the other `axis` is what the spring at the axis carries
    then, per branch, and `kept` what all pressed ones lack to as much. `springs` and `even`, the former's twin, are of
    the motion whose depth grows evenly, which the energy is kept for. `place`: the edge's, where it grows.
    """

    now: Instant
    springs: Springs
    even: Values
    axis: Values
    kept: Values
    spent: float
    released: float
    place: Place | None = None


class SpringsInRow:
    """The state after the steps taken, the places that the edge has passed, and energies of one half so far, J."""

    def __init__(self, problem: RowProblem) -> None:
        nothing = [0.0] * len(problem.modulus.moduli)
        self.problem = problem
        self.springs = none(problem.modulus)
        self.even = self.axis = self.kept = nothing
        self.places = [Place(0.0, 0.0, 0.0, nothing, self.springs, nothing)]
        self.spent = self.released = 0.0

    def copy(self) -> SpringsInRow:
        """The same state, to go on from on its own."""
        other = copy(self)
        other.places = list(self.places)
        return other

    def take(self, step: RowStep) -> None:
        """Take a step: of the approach where it has a place, else of the rebound."""
        self.springs, self.even, self.axis, self.kept = step.springs, step.even, step.axis, step.kept
        self.spent += step.spent
        self.released += step.released
        if step.place:
            self.places.append(step.place)
        else:
            self.places.pop()

    def instant(
        self, time: float, depth: float, velocity: float, edge: float, springs: Springs, axis: Values, kept: Values
    ) -> Instant:
        """The motion with its force: that of pressed springs which have kept as much."""
        modulus, mass, gravity = self.problem.modulus, self.problem.mass, self.problem.gravity
        force = 2.0 * springs.force(modulus, depth, velocity, axis, kept)
        return Instant(time, depth, velocity, gravity - force / mass, force, edge)


def followed(modulus: Relaxation, memory: Values, faded: list[Fading], begin: float, end: float, h: float) -> Values:
    """Memories z' = E q - z/tau after a time in which q runs evenly from one value to the other."""
    branches, change = zip(modulus.moduli, memory, faded, strict=True), (end - begin) / h
    return [z * fade.left + e * (begin * fade.filled + change * fade.grown) for e, z, fade in branches]


def followed_bend(
    modulus: Relaxation, memory: Values, faded: list[Fading], begin: float, mean: float, end: float, h: float
) -> Values:
    """The same where q is a parabola between them with this mean."""
    slope, bend = (6.0 * mean - 4.0 * begin - 2.0 * end) / h, 3.0 * (begin + end - 2.0 * mean) / h
    branches = zip(modulus.moduli, memory, faded, strict=True)
    return [z * f.left + e * (begin * f.filled + slope * f.grown + bend * f.bent) for e, z, f in branches]


def left(modulus: Relaxation, h: float) -> Values:
    """The share exp(-h/tau_k) that is left of every branch."""
    return [math.exp(-h / tau) for tau in modulus.times]
