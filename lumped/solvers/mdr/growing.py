"""One step of the approach: the edge stands where the profile meets the surface."""

from __future__ import annotations

import math

from lumped.errors import NotReached
from lumped.solvers.mdr.memory import Fading, fadings
from lumped.solvers.mdr.row import Instant, Place, Row, Step, followed, followed_bend
from lumped.solvers.mdr.springs import Springs, Values, stretched, yielding

SECANTS = 60
# The last correction of the rate; what is left after it is the product of two such.
CONVERGED = 1e-9
# Gauss' two points on (0, 1).
GAUSS = (0.5 - 0.5 / math.sqrt(3.0), 0.5 + 0.5 / math.sqrt(3.0))


def grown(row: Row, now: Instant, h: float) -> Step:
    """A step of length h, s, not yet taken. Raises NotReached."""
    modulus = row.problem.modulus
    faded = fadings(modulus, h)
    rate, width, pressed = _rate(row, now, h, faded)
    rest = now.depth + rate * (h - pressed)
    shortly, fresh = fadings(modulus, pressed), [0.0] * len(faded)
    even, own = stretched(modulus, row.even, faded, rate), stretched(modulus, fresh, shortly, rate)
    joined = Springs.one(width, rest, [z - mine for z, mine in zip(even, own, strict=True)])
    springs = row.springs.aged([fade.left for fade in faded]).plus(joined)
    spent = row.springs.spent(modulus, row.even, faded, h, rate)
    spent += Springs(width, 0.0, 0.0, fresh, fresh).spent(modulus, fresh, shortly, pressed, rate)
    velocity, depth, edge = 2.0 * rate - now.velocity, now.depth + h * rate, now.edge + width
    axis = followed(modulus, row.axis, faded, now.velocity, velocity, h)
    kept = _kept(row, now, (velocity, edge, now.edge * rate + width * (depth - rest) / h), axis, faded, h)
    lately = [k - before * fade.left for k, before, fade in zip(kept, row.kept, faded, strict=True)]
    instant = row.instant(now.time + h, depth, velocity, edge, springs, axis, kept)
    place = Place(instant.time, depth, edge, axis, joined, lately)
    return Step(instant, springs, even, axis, kept, spent, 0.0, place)


def _kept(
    row: Row, now: Instant, after: tuple[float, float, float], axis: Values, faded: list[Fading], h: float
) -> Values:
    """What all pressed springs lack, after a step, to as many like the one at the axis; with `after` the velocity and
    the edge then, and the mean of their product over the step: by so much the springs are stretched.
    """
    modulus, (velocity, edge, mean) = row.problem.modulus, after
    load = [now.edge * z - k for z, k in zip(row.axis, row.kept, strict=True)]
    load = followed_bend(modulus, load, faded, now.edge * now.velocity, mean, edge * velocity, h)
    return [edge * z - y for z, y in zip(axis, load, strict=True)]


def _rate(row: Row, now: Instant, h: float, faded: list[Fading]) -> tuple[float, float, float]:
    """The rate at which the depth grows: m (v1 - v0) = m g h - int F dt with v0 + v1 twice the rate.

    With it what `_touched` says.
    """
    modulus, mass, width = row.problem.modulus, row.problem.mass, row.springs.width
    coasting = now.velocity + 0.5 * h * row.problem.gravity
    coasting -= row.springs.impulse(modulus, now.depth, row.even, faded, h) / mass
    give = yielding(modulus, faded, h) / mass
    rate, before, missed = now.velocity + 0.5 * h * now.acceleration, 0.0, 0.0
    for secant in range(SECANTS):
        wider, pressed = _touched(row, now, h, rate)
        own = wider * yielding(modulus, fadings(modulus, pressed), pressed) / mass if wider else 0.0
        miss = rate * (1.0 + width * give + own) - coasting
        slope = 1.0 + (width + wider) * give
        if secant and rate != before:
            slope = max((miss - missed) / (rate - before), 0.1 * slope)
        before, missed = rate, miss
        rate -= miss / slope
        if abs(rate - before) <= CONVERGED * (abs(now.velocity) + abs(rate)):
            return rate, wider, pressed
    raise NotReached("the velocity within one step of the spring row did not converge")


def _touched(row: Row, now: Instant, h: float, rate: float) -> tuple[float, float]:
    """Width of the springs that a step touches, m, and for how long they are pressed, s, by their mean profile."""
    curve, depth = row.problem.shape.load_curve, now.depth + h * rate
    width = float(curve.contact_radius(depth)) - now.edge if rate > 0.0 else 0.0
    if width <= 0.0:
        return 0.0, 0.0
    low, high = (float(curve.depth(now.edge + share * width)) for share in GAUSS)
    return width, min(max((depth - 0.5 * (low + high)) / rate, 0.0), h)
