"""One step of the rebound: the edge runs over the ground of the last step of the approach that is left."""

from __future__ import annotations

from typing import NamedTuple

from lumped.solvers.mdr.memory import Fading, fadings
from lumped.solvers.mdr.row import Instant, Row, Step, followed, left
from lumped.solvers.mdr.springs import Values, stretched, yielding

# A step that takes no time, s.
LEAST = 1e-200


class Attempt(NamedTuple):
    """A step of length h: its rate, the fadings over it and until the springs leave, what the axis carries after it.

    `pull`: force per length of the spring at the place to which the edge runs.
    """

    h: float
    rate: float
    velocity: float
    faded: list[Fading]
    shortly: list[Fading]
    axis: Values
    pull: float


class Shrinking:
    """Steps of any length from an instant; the springs of that ground are pressed for a share of it."""

    def __init__(self, row: Row, now: Instant) -> None:
        modulus, last = row.problem.modulus, row.places[-1]
        self.row, self.now, self.place = row, now, row.places[-2]
        shares = left(modulus, now.time - last.time)
        # what the spring at the place to which the edge runs lacks now to the one at the axis
        since = left(modulus, now.time - self.place.time)
        self.lacking = [kept * share for kept, share in zip(self.place.axis, since, strict=True)]
        self.leaving = last.springs.aged(shares)
        self.kept = [k - own * share for k, own, share in zip(row.kept, last.kept, shares, strict=True)]
        self.staying = row.springs.plus(self.leaving, -1.0)
        ground = (last.depth - self.place.depth) * self.leaving.width
        self.share = (last.depth * self.leaving.width - self.leaving.rest) / ground if ground > 0.0 else 0.0

    @property
    def pull(self) -> float:
        """Force per length, now, of the spring at the place to which the edge runs."""
        lift = self._lift(self.now.depth, self.now.velocity)
        return lift + sum(self.row.axis) - sum(self.lacking)

    def attempt(self, h: float) -> Attempt:
        """A step of this length: m (v1 - v0) = m g h - int F dt with v0 + v1 twice the rate."""
        problem, modulus, now, even = self.row.problem, self.row.problem.modulus, self.now, self.row.even
        h = max(h, LEAST)
        pressed = self.share * h
        faded, shortly = fadings(modulus, h), fadings(modulus, pressed)
        passed = self.staying.impulse(modulus, now.depth, even, faded, h)
        passed += self.leaving.impulse(modulus, now.depth, even, shortly, pressed)
        give = self.staying.width * yielding(modulus, faded, h)
        give += self.leaving.width * yielding(modulus, shortly, pressed)
        rate = (now.velocity + 0.5 * h * problem.gravity - passed / problem.mass) / (1.0 + give / problem.mass)
        velocity = 2.0 * rate - now.velocity
        axis = followed(modulus, self.row.axis, faded, now.velocity, velocity, h)
        pull = self._lift(now.depth + h * rate, velocity)
        for z, lack, fade in zip(axis, self.lacking, faded, strict=True):
            pull += z - lack * fade.left
        return Attempt(h, rate, velocity, faded, shortly, axis, pull)

    def _lift(self, depth: float, velocity: float) -> float:
        """What the spring at the place carries without its branches."""
        modulus = self.row.problem.modulus
        return modulus.equilibrium * (depth - self.place.depth) + modulus.viscosity * velocity

    def step(self, tried: Attempt) -> Step:
        """The step which was tried, not yet taken."""
        row, now, (h, rate, velocity, faded, shortly, axis, _) = self.row, self.now, tried
        modulus = row.problem.modulus
        pressed = self.share * h
        spent = self.staying.spent(modulus, row.even, faded, h, rate)
        spent += self.leaving.spent(modulus, row.even, shortly, pressed, rate)
        parted = self.leaving.aged([fade.left for fade in shortly])
        released = parted.held(modulus, now.depth + rate * pressed, stretched(modulus, row.even, shortly, rate))
        springs = self.staying.aged([fade.left for fade in faded])
        even = stretched(modulus, row.even, faded, rate)
        kept = [k * fade.left for k, fade in zip(self.kept, faded, strict=True)]
        instant = row.instant(now.time + h, now.depth + h * rate, velocity, self.place.edge, springs, axis, kept)
        return Step(instant, springs, even, axis, kept, spent, released)
