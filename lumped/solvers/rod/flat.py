"""A mass whose flat end strikes the whole section of a rod: St Venant's series, one piece an echo.

With p = f'/v, q = p a delay before, time s in units of m/Z since the last echo and gravity gamma = m g/(Z v), Newton's
m (f' + g')' = -Z (f' - g') + m g reads

    p' + p = -echo (q' - q) + gamma,    p = shift + exp(-s) Q(s),    Q' = -echo (Q_before' - 2 Q_before),

the striker's velocity p + echo q without a jump: polynomials Q, exact. St Venant and Flamant 1883; Goldsmith,
Impact (1960), ch. 3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from lumped.errors import NotReached
from lumped.solvers.rod.waves import Waves

Array = NDArray[np.float64]
MOST_ECHOES = 400
PLACES = 65  # in a piece, where its greatest force and its zeros are looked for
FADING = np.linspace(0.0, 30.0, 601)[1:]  # m/Z until what is left of a front is rounding, and so many places in it
NOTHING = Polynomial([0.0])


@dataclass(frozen=True)
class RodPiece:
    """What leaves between two echoes, over the striker's velocity at touch: ``shift`` + exp(-s) ``factor``(s)."""

    shift: float
    factor: Polynomial

    def __call__(self, s: Array | float) -> Array:
        """p, shape of s."""
        return np.asarray(self.shift + np.exp(-np.asarray(s)) * self.factor(s))


STILL = RodPiece(0.0, NOTHING)


@dataclass(frozen=True)
class FlatImpact:
    """One impact: masses in kg, velocity in m/s, gravity along the motion in m/s2; followed until ``until``, s."""

    waves: Waves
    mass: float
    velocity: float
    gravity: float
    until: float

    @property
    def unit(self) -> float:
        """m/Z, s."""
        return self.mass / self.waves.impedance

    @cached_property
    def pieces(self) -> tuple[tuple[RodPiece, ...], float, bool]:
        """The pieces, the time at which contact ends or is no longer followed, s, and whether it ended."""
        weight = self.gravity * self.unit / self.velocity
        alpha, echo = self.waves.delay / self.unit, self.waves.echo
        found = [RodPiece(weight, Polynomial([1.0 - weight]))]
        while len(found) <= MOST_ECHOES:
            begin = 0.0 if len(found) == 1 else (len(found) - 1) * self.waves.delay
            longest = min(alpha, (self.until - begin) / self.unit)
            leaves = self._leaves(found, longest)
            if leaves is not None:
                return tuple(found), begin + leaves * self.unit, True
            if longest < alpha:
                return tuple(found), self.until, False
            found.append(_next(found, alpha, echo, weight))
        raise NotReached(f"rod: more than {MOST_ECHOES} echoes; accepted: a heavier rod, an earlier motion.end_time")

    def _leaves(self, pieces: list[RodPiece], longest: float) -> float | None:
        """When the force of the last piece first falls to zero, in its own time; None where it does not."""
        now, before = pieces[-1], pieces[-2] if len(pieces) > 1 else STILL
        reach = longest if math.isfinite(longest) else 1.0
        places = np.linspace(0.0, reach, PLACES)
        force = now(places) - self.waves.echo * before(places)
        negative = np.flatnonzero(force <= 0.0)
        if len(pieces) == 1 or negative.size == 0:
            return None  # the first force only decays
        if negative[0] == 0:
            return 0.0
        from scipy.optimize import brentq

        ends = places[negative[0] - 1], places[negative[0]]
        return float(brentq(lambda s: float(now(s) - self.waves.echo * before(s)), *ends, xtol=1e-15, rtol=1e-14))

    @property
    def starts(self) -> Array:
        """Times at which echoes arrive, from touch on, s."""
        pieces, end, _ = self.pieces
        return self.waves.arrivals(len(pieces), end)

    def steps(self, begin: float, end: float) -> Array:
        """Times between two others, s, as many as the forces between them need: they fade within m/Z."""
        return np.asarray(begin + self.unit * FADING[(end - begin) / self.unit > FADING])

    def columns(self, times: Array) -> Array:
        """Depth, velocity, force, and what leaves, f', at times (n,): SI, shape (4, n). At an echo what follows it."""
        leaves, came = self._waves(times)
        velocity, force = self.velocity * (leaves + came), self.velocity * self.waves.impedance * (leaves - came)
        return np.asarray([self._depth(times), velocity, force, self.velocity * leaves])

    def _waves(self, times: Array) -> tuple[Array, Array]:
        """p and echo q at times (n,)."""
        pieces, _, _ = self.pieces
        starts, echo = self.starts, self.waves.echo
        place = np.clip(np.searchsorted(starts, times, side="right") - 1, 0, len(pieces) - 1)
        leaves, came = np.empty_like(times), np.zeros_like(times)
        for index in np.unique(place):
            here = place == index
            s = (times[here] - starts[index]) / self.unit
            leaves[here] = pieces[index](s)
            if index:
                came[here] = echo * pieces[index - 1](s)
        return leaves, came

    def _depth(self, times: Array) -> Array:
        """f + g by the impulse J = int F dt: f = J/Z + g, and g is echo f a delay before."""
        depth = np.zeros_like(times)
        for echoes in range(len(self.pieces[0])):
            ago = times - echoes * self.waves.delay if echoes else times
            struck = np.maximum(ago, 0.0)
            speed = self.velocity * np.sum(self._waves(struck), axis=0)
            impulse = self.mass * (self.velocity - speed + self.gravity * struck)
            weight = 2.0 * self.waves.echo**echoes if echoes else 1.0
            depth += np.where(ago > 0.0, weight * impulse / self.waves.impedance, 0.0)
        return depth


def _next(found: list[RodPiece], alpha: float, echo: float, weight: float) -> RodPiece:
    last, before = found[-1], found[-2] if len(found) > 1 else STILL
    factor = (-echo * (last.factor.deriv() - 2.0 * last.factor)).integ()
    # the shift of a piece keeps p - echo q = weight
    shift = weight + echo * last.shift
    velocity = float(last(alpha) + echo * before(alpha))
    start = velocity - echo * float(last(0.0))
    return RodPiece(shift, factor + (start - shift))
