"""One step of the rebound: the edge runs over the ground of the last step of the approach that is left."""

from __future__ import annotations

from lumped.spring_row.memory import fadings
from lumped.spring_row.row import Instant, Row, Step, followed, left
from lumped.spring_row.springs import stretched, yielding


class Shrinking:
    """Steps of any length from an instant; the springs of that ground are pressed for a share of it."""

    def __init__(self, row: Row, now: Instant) -> None:
        modulus, last = row.problem.modulus, row.places[-1]
        self.row, self.now, self.place = row, now, row.places[-2]
        shares = left(modulus, now.time - last.time)
        self.leaving = last.springs.aged(shares)
        self.kept = [k - own * share for k, own, share in zip(row.kept, last.kept, shares, strict=True)]
        self.staying = row.springs.plus(self.leaving, -1.0)
        ground = (last.depth - self.place.depth) * self.leaving.width
        self.share = (last.depth * self.leaving.width - self.leaving.rest) / ground if ground > 0.0 else 0.0

    def rate(self, h: float) -> float:
        """The rate at which the depth grows: m (v1 - v0) = m g h - int F dt with v0 + v1 twice the rate."""
        problem, modulus, now, even = self.row.problem, self.row.problem.modulus, self.now, self.row.even
        pressed = self.share * h
        faded, shortly = fadings(modulus, h), fadings(modulus, pressed)
        passed = self.staying.impulse(modulus, now.depth, even, faded, h)
        passed += self.leaving.impulse(modulus, now.depth, even, shortly, pressed)
        give = self.staying.width * yielding(modulus, faded, h)
        give += self.leaving.width * yielding(modulus, shortly, pressed)
        return (now.velocity + 0.5 * h * problem.gravity - passed / problem.mass) / (1.0 + give / problem.mass)

    def pull(self, h: float) -> float:
        """Force per length, after a step, of the spring at the place to which the edge runs; of h = 0 now."""
        modulus, now, axis = self.row.problem.modulus, self.now, self.row.axis
        depth, velocity = now.depth, now.velocity
        if h:
            rate = self.rate(h)
            depth, velocity = now.depth + h * rate, 2.0 * rate - now.velocity
            axis = followed(modulus, axis, fadings(modulus, h), now.velocity, velocity, h)
        lift = modulus.equilibrium * (depth - self.place.depth) + modulus.viscosity * velocity
        shares = left(modulus, now.time + h - self.place.time)
        return lift + sum(z - kept * share for z, kept, share in zip(axis, self.place.axis, shares, strict=True))

    def velocity(self, h: float) -> float:
        """The velocity after a step."""
        return 2.0 * self.rate(h) - self.now.velocity if h else self.now.velocity

    def step(self, h: float) -> Step:
        """A step of this length, not yet taken."""
        row, now, modulus, rate = self.row, self.now, self.row.problem.modulus, self.rate(h)
        pressed = self.share * h
        faded, shortly = fadings(modulus, h), fadings(modulus, pressed)
        spent = self.staying.spent(modulus, row.even, faded, h, rate)
        spent += self.leaving.spent(modulus, row.even, shortly, pressed, rate)
        parted = self.leaving.aged([fade.left for fade in shortly])
        released = parted.held(modulus, now.depth + rate * pressed, stretched(modulus, row.even, shortly, rate))
        springs = self.staying.aged([fade.left for fade in faded])
        even = stretched(modulus, row.even, faded, rate)
        velocity, depth = 2.0 * rate - now.velocity, now.depth + h * rate
        axis = followed(modulus, row.axis, faded, now.velocity, velocity, h)
        kept = [k * fade.left for k, fade in zip(self.kept, faded, strict=True)]
        instant = row.instant(now.time + h, depth, velocity, self.place.edge, springs, axis, kept)
        return Step(instant, springs, even, axis, kept, spent, released)
