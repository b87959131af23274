"""The row of springs: what is pressed now, and where the edge of contact has been.

Springs that are pressed together are sums over them; all forces and energies are those of one half of the row. A spring
at x carries, per length, E_inf (depth - g) + eta depth' + sum z_k with z_k' = E_k depth' - z_k/tau_k. Springs in
contact are stretched alike, so z_k = Z_k - c_k: Z_k is that of the spring at the axis, c_k what that one carried when
this one was touched, and has kept since.

Within a step the depth grows evenly, at the mean of the velocities at its ends: the time integral of Newton's law tells
this mean. Everything else follows in closed form, so the energy of mass, springs and dashpots is kept to rounding,
however long the steps are: how branches fade meanwhile are integrals over time, in closed form. The springs between two
places of the edge count as one, with their mean profile.
"""

from __future__ import annotations

import math
from copy import copy
from dataclasses import dataclass
from typing import NamedTuple

from lumped.materials import Relaxation
from lumped.shapes import Shape

Values = list[float]
SERIES_BELOW = 0.5  # of a time over the relaxation time: below it the closed forms would lose digits
# 2 (-1)^j/(j+3)!
C0, C1, C2, C3, C4, C5, C6, C7, C8, C9, C10, C11 = (2.0 * (-1.0) ** j / math.factorial(j + 3) for j in range(12))


class Fading(NamedTuple):
    """Of one branch over a time h, with u the time left of it and e = exp(-u/tau).

    `left` = exp(-h/tau), `filled` = int e du, `grown` = int e (h-u) du, `bent` = int e (h-u)^2/h du, and `spilled` =
    tau int (1-e)^2 du.
    """

    left: float
    filled: float
    grown: float
    bent: float
    spilled: float


def fading(tau: float, h: float) -> Fading:
    """The integrals, to full relative precision from h << tau to h >> tau."""
    x = h / tau
    if x < SERIES_BELOW:
        second = C6 + x * (C7 + x * (C8 + x * (C9 + x * (C10 + x * C11))))
        second = C0 + x * (C1 + x * (C2 + x * (C3 + x * (C4 + x * (C5 + x * second)))))
        first = 0.5 * (1.0 - x * second)
        zeroth = 1.0 - x * first
        third = first - 0.5 * second - 0.5 * x * first * first
        return Fading(1.0 - x * zeroth, h * zeroth, h * h * first, h * h * second, h * h * x * third)
    left = math.exp(-x)
    gone = 1.0 - left
    grown = x - gone
    bent, spilled = x - 2.0 * grown / x, grown - 0.5 * gone * gone
    return Fading(left, tau * gone, tau * tau * grown, tau * tau * bent, tau * tau * spilled)


def fadings(modulus: Relaxation, h: float) -> list[Fading]:
    """Those of every branch."""
    return [fading(tau, h) for tau in modulus.times]


class Springs(NamedTuple):
    """Sums over springs of their widths w, and of w g, w g^2, and per branch w c_k, w c_k^2."""

    width: float
    rest: float
    rest_square: float
    kept: Values
    kept_square: Values

    @classmethod
    def one(cls, width: float, rest: float, kept: Values) -> Springs:
        """A single spring of this width, touched at the depth `rest`."""
        return cls(width, width * rest, width * rest * rest, [width * c for c in kept], [width * c * c for c in kept])

    def plus(self, other: Springs, sign: float = 1.0) -> Springs:
        """These and those; with the sign -1 these without those."""
        return Springs(
            self.width + sign * other.width,
            self.rest + sign * other.rest,
            self.rest_square + sign * other.rest_square,
            [mine + sign * its for mine, its in zip(self.kept, other.kept, strict=True)],
            [mine + sign * its for mine, its in zip(self.kept_square, other.kept_square, strict=True)],
        )

    def aged(self, left: Values) -> Springs:
        """The same when of every branch this share is left."""
        kept = [c * share for c, share in zip(self.kept, left, strict=True)]
        square = [c * share * share for c, share in zip(self.kept_square, left, strict=True)]
        return Springs(self.width, self.rest, self.rest_square, kept, square)

    def force(self, modulus: Relaxation, depth: float, velocity: float, axis: Values, kept: Values) -> float:
        """What they carry, N, when they have kept this."""
        lift = modulus.equilibrium * depth + modulus.viscosity * velocity + sum(axis)
        return lift * self.width - modulus.equilibrium * self.rest - sum(kept)

    def impulse(self, modulus: Relaxation, depth: float, axis: Values, faded: list[Fading], h: float) -> float:
        """What they pass on over a time h from this state while the depth rests, N s."""
        total = modulus.equilibrium * (depth * self.width - self.rest) * h
        for z, kept, fade in zip(axis, self.kept, faded, strict=True):
            total += (self.width * z - kept) * fade.filled
        return total

    def spent(self, modulus: Relaxation, axis: Values, faded: list[Fading], h: float, rate: float) -> float:
        """What their dashpots spend while the depth grows evenly for a time h, J: int z^2/(E tau) dt, eta rate^2 h."""
        total = modulus.viscosity * rate * rate * self.width * h
        for k, (stiffness, tau, fade) in enumerate(zip(modulus.moduli, modulus.times, faded, strict=True)):
            first, second = self._moments(k, axis)
            total += 0.5 * fade.filled * (1.0 + fade.left) * second / (stiffness * tau)
            total += fade.filled * fade.filled * rate * first / tau
            total += stiffness * rate * rate * fade.spilled * self.width
        return total

    def held(self, modulus: Relaxation, depth: float, axis: Values) -> float:
        """What their springs hold, J: E_inf (depth - g)^2/2 and z_k^2/(2 E_k)."""
        total = modulus.equilibrium * (depth * (depth * self.width - 2.0 * self.rest) + self.rest_square)
        for k, stiffness in enumerate(modulus.moduli):
            total += self._moments(k, axis)[1] / stiffness
        return 0.5 * total

    def _moments(self, k: int, axis: Values) -> tuple[float, float]:
        """Sums of w z_k and of w z_k^2."""
        z, kept = axis[k], self.kept[k]
        return self.width * z - kept, z * (self.width * z - 2.0 * kept) + self.kept_square[k]


def none(modulus: Relaxation) -> Springs:
    """No spring."""
    return Springs.one(0.0, 0.0, [0.0] * len(modulus.moduli))


def yielding(modulus: Relaxation, faded: list[Fading], h: float) -> float:
    """By how much the impulse over a time h rises with the rate at which the depth grows, per width."""
    total = (0.5 * modulus.equilibrium * h + modulus.viscosity) * h
    for stiffness, fade in zip(modulus.moduli, faded, strict=True):
        total += stiffness * fade.grown
    return total


def stretched(modulus: Relaxation, axis: Values, faded: list[Fading], rate: float) -> Values:
    """Z_k after a time in which the depth grew evenly at this rate."""
    branches = zip(modulus.moduli, axis, faded, strict=True)
    return [z * fade.left + stiffness * rate * fade.filled for stiffness, z, fade in branches]


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
    released: float = 0.0
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
