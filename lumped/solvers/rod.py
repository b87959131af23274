"""One-dimensional waves in an elastic rod, seen from its struck end (d'Alembert), and two impacts that send them.

The end moves with f' + g', f' of the wave that leaves and g' of the one that comes back, and is pressed with

    F = Z (f' - g'),    g'(t) = echo f'(t - delay),    Z = density c A = A sqrt(E density),

echo -1 of a held other end, 1 of a free one, 0 of a rod without an end. Graff, Wave Motion in Elastic Solids, ch. 2
(ISBN 978-0-486-66745-4).

A mass whose flat end strikes the whole section: St Venant's series, one piece an echo. With p = f'/v, q = p a delay
before, time s in units of m/Z since the last echo and gravity gamma = m g/(Z v), Newton's
m (f' + g')' = -Z (f' - g') + m g reads

    p' + p = -echo (q' - q) + gamma,    p = shift + exp(-s) Q(s),    Q' = -echo (Q_before' - 2 Q_before),

the striker's velocity p + echo q without a jump: polynomials Q, exact. St Venant and Flamant 1883; Goldsmith,
Impact (1960), ch. 3.

A mass that dents the rod's end: an ordinary equation between two echoes,

    m x'' = -F + m g,    u' = F/Z + 2 g',    F = force(x - u),    f' = F/Z + g',    g'(t) = echo f'(t - delay),

x of the striker, u of the rod's end; a delay equation, integrated echo by echo, exact to the integrator's tolerance.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import count
from typing import Protocol

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from lumped.errors import NotReached
from lumped.numbers import Array, Real, gauss
from lumped.progress import step_done
from lumped.scene.scene import Scene
from lumped.targets.rod import Rod

GAUSS_POINTS = 24  # Gauss points between two rows, for the energy that waves carry
MOST_PIECES = 400  # work: echoes of the exact series, each a polynomial
PLACES = 65  # in a piece, where its greatest force and its zeros are looked for
FADING = np.linspace(0.0, 30.0, 601)[1:]  # m/Z until what is left of a front is rounding, and so many places in it
NOTHING = Polynomial([0.0])
MOST_ECHOES, MOST_STEPS = 100, 20_000  # work: echoes that are integrated, each through all before it; steps of all
LONGEST, FIRST = 0.25, 4e-3  # steps, as `longest` says, and the first one over that
ABSOLUTE = 1e-2  # over the relative tolerance, in units of the elastic impact
STRIKER, SPEED, END = range(3)  # of the state that is integrated


@dataclass(frozen=True)
class Waves:
    """Impedance Z, N s/m; delay of the echo, there and back, s; echo; transit to the other end, s."""

    impedance: float
    echo: float
    transit: float

    @property
    def delay(self) -> float:
        """Time to the other end and back, s; infinite where nothing comes back."""
        return 2.0 * self.transit if self.echo else math.inf

    def arrivals(self, pieces: int, end: float) -> Array:
        """When so many pieces of a motion begin, s, (pieces,): at touch and with every echo, none after the end."""
        delay = self.delay if pieces > 1 else 0.0
        return np.asarray(np.minimum(delay * np.arange(pieces), end))

    @classmethod
    def of(cls, scene: Scene) -> Waves:
        """Of a scene whose target is an elastic rod."""
        rod, material = scene.target, scene.geometry.material
        assert isinstance(rod, Rod)
        modulus, density = material.uniaxial_modulus().relaxed, material.density or 0.0
        return cls(rod.impedance(modulus, density), rod.echo, rod.length * math.sqrt(density / modulus))

    def energies(self, leaving: Callable[[Array], Array], rows: Array) -> tuple[float, float]:
        """Energy in the rod, kinetic and elastic, at the last of the times ``rows``, and what left it, J.

        ``leaving`` f' over time (n,), smooth between two rows. A rod that echoes holds the waves of the last delay, an
        endless one those of the last transit: what is older has passed the length.
        """
        held = 2.0 * self.transit if self.echo else self.transit
        first = max(rows[-1] - held, 0.0)
        early, late = (np.unique(np.clip(rows, *ends)) for ends in ((0.0, first), (first, rows[-1])))
        inside = self._carried(leaving, late)
        return inside, 0.0 if self.echo else self._carried(leaving, early)

    def _carried(self, leaving: Callable[[Array], Array], rows: Array) -> float:
        """Z int f'^2 dt, by Gauss between the rows."""
        nodes, weights = gauss(GAUSS_POINTS)
        length = np.diff(rows)
        times = rows[:-1, None] + length[:, None] * nodes
        values = leaving(times.ravel()).reshape(times.shape)
        return float(self.impedance * np.sum(length[:, None] * weights * values**2))


@dataclass(frozen=True)
class RodPiece:
    """A function of s between two echoes: ``shift`` + ``slope`` s + exp(-s) ``factor``(s).

    What leaves, p, over the striker's velocity at touch, has no slope; its integral, over that and m/Z, may have one.
    """

    shift: float
    factor: Polynomial
    slope: float = 0.0

    def __call__(self, s: Array | float) -> Array:
        """Its value, shape of s."""
        s = np.asarray(s)
        return np.asarray(self.shift + self.slope * s + np.exp(-s) * self.factor(s))


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
        while len(found) <= MOST_PIECES:
            step_done()
            begin = 0.0 if len(found) == 1 else (len(found) - 1) * self.waves.delay
            longest = min(alpha, (self.until - begin) / self.unit)
            leaves = self._leaves(found, longest)
            if leaves is not None:
                return tuple(found), begin + leaves * self.unit, True
            if longest < alpha:
                return tuple(found), self.until, False
            found.append(_next(found, alpha, echo, weight))
        raise NotReached(f"rod: more than {MOST_PIECES} echoes; accepted: a heavier rod, an earlier motion.end_time")

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
        pieces, starts, echo = self.pieces[0], self.starts, self.waves.echo
        leaves, came = np.empty_like(times), np.zeros_like(times)
        for index, here in _by_piece(starts, times):
            s = (times[here] - starts[index]) / self.unit
            leaves[here] = pieces[index](s)
            if index:
                came[here] = echo * pieces[index - 1](s)
        return leaves, came

    @cached_property
    def _travels(self) -> list[RodPiece]:
        """How far what leaves has moved the rod's end, a piece an echo, see :meth:`_depth`."""
        weight, echo = self.gravity * self.unit / self.velocity, self.waves.echo
        found, before, earlier = list[RodPiece](), STILL, STILL
        for piece, start in zip(self.pieces[0], self.starts / self.unit, strict=True):
            shift = 1.0 + weight * float(start) - piece.shift - echo * before.shift + echo * earlier.shift
            factor = echo * earlier.factor - piece.factor - echo * before.factor
            before, earlier = piece, RodPiece(shift, factor, weight + echo * earlier.slope)
            found.append(earlier)
        return found

    def _depth(self, times: Array) -> Array:
        """f + g by the impulse J = int F dt: f = J/Z + g, and g is echo f a delay before."""
        depth, struck = np.empty_like(times), np.maximum(times, 0.0)
        starts, travels, echo = self.starts, self._travels, self.waves.echo
        for index, here in _by_piece(starts, struck):
            s = (struck[here] - starts[index]) / self.unit
            depth[here] = travels[index](s) + (echo * travels[index - 1](s) if index else 0.0)
        return self.velocity * self.unit * depth


def _by_piece(starts: Array, times: Array) -> Iterator[tuple[int, NDArray[np.bool_]]]:
    """The pieces that begin at `starts`, in which some of the times are, and which; the first knows what is earlier."""
    place = np.searchsorted(starts[1:], times, side="right")
    for index in np.unique(place):
        yield int(index), place == index


def _next(found: list[RodPiece], alpha: float, echo: float, weight: float) -> RodPiece:
    last, before = found[-1], found[-2] if len(found) > 1 else STILL
    factor = (-echo * (last.factor.deriv() - 2.0 * last.factor)).integ()
    # the shift of a piece keeps p - echo q = weight
    shift = weight + echo * last.shift
    velocity = float(last(alpha) + echo * before(alpha))
    start = velocity - echo * float(last(0.0))
    return RodPiece(shift, factor + (start - shift))


class _BetweenEchoes(Protocol):
    """The states x, x', u between two echoes, at the times of an integrator's steps `ts`, s, and at any others."""

    ts: Array

    def __call__(self, t: Real) -> Array: ...


@dataclass(frozen=True)
class TippedImpact:
    """One impact: ``force`` over the dent's depth, N and m; mass, kg; velocity, m/s; gravity along the motion, m/s2.

    ``depth``, m, and ``time``, s, are those of the elastic impact on a body that sends no waves. Followed until
    ``until``, s, each step to ``rtol``, and no longer than a share ``longest`` of that time and of the one between two
    echoes.
    """

    waves: Waves
    force: Callable[[Real], Real]
    mass: float
    velocity: float
    gravity: float
    until: float
    depth: float
    time: float
    rtol: float
    longest: float = LONGEST

    @cached_property
    def pieces(self) -> tuple[tuple[_BetweenEchoes, ...], float, bool]:
        """A dense answer an echo, when contact ends or is no longer followed, s, and whether it ended.

        Raises NotReached.
        """
        from scipy.integrate import solve_ivp

        longest = self.longest * min(self.time, self.waves.delay)
        state, found, begin = np.array([0.0, self.velocity, 0.0]), list[_BetweenEchoes](), 0.0
        tolerances = self.rtol * ABSOLUTE * np.array([self.depth, self.velocity, self.depth])
        cure, steps = "accepted: a heavier rod, an earlier motion.end_time", count()

        def parted(_: float, y: Array) -> float:
            step_done()
            if next(steps) > MOST_STEPS:
                raise NotReached(f"rod: more than {MOST_STEPS} steps; {cure}")
            return float(y[STRIKER] - y[END])

        parted.terminal, parted.direction = True, -1.0  # type: ignore[attr-defined]  # how solve_ivp is told
        while len(found) <= MOST_ECHOES:
            end = min(begin + self.waves.delay, self.until)
            rates = self._rates(found, begin)
            first = min(FIRST * longest, end - begin)
            solved = solve_ivp(
                rates, (begin, end), state, "DOP853", events=parted, rtol=self.rtol, atol=tolerances,
                dense_output=True, first_step=first, max_step=longest,
            )  # fmt: skip
            if solved.status < 0 or solved.sol is None:
                raise NotReached(f"rod: {solved.message}; accepted: a looser tolerance")
            found.append(solved.sol)
            if solved.status == 1 or end >= self.until:
                return tuple(found), float(solved.t[-1]), solved.status == 1
            state, begin = solved.y[:, -1], end
        raise NotReached(f"rod: more than {MOST_ECHOES} echoes; {cure}")

    def _rates(self, before: list[_BetweenEchoes], begin: float) -> Callable[[float, Array], list[float]]:
        """Rates between two echoes, ``before`` what was found of the time until ``begin``."""
        impedance, delay = self.waves.impedance, self.waves.delay
        chain = before[::-1]

        def came(time: float) -> float:
            """g': what pressed at every delay before now, the echo's sign to its power."""
            total, weight = 0.0, 1.0
            for echoes, answer in enumerate(chain, 1):
                y = answer(time - echoes * delay)
                weight *= self.waves.echo
                total += weight * self.force(max(float(y[STRIKER] - y[END]), 0.0))
            return float(total / impedance)

        def rates(time: float, y: Array) -> list[float]:
            force = float(self.force(max(float(y[STRIKER] - y[END]), 0.0)))
            return [y[SPEED], self.gravity - force / self.mass, force / impedance + 2.0 * came(time)]

        return rates

    @property
    def starts(self) -> Array:
        """Times at which echoes arrive, from touch on, s."""
        pieces, end, _ = self.pieces
        return self.waves.arrivals(len(pieces), end)

    def steps(self, begin: float, end: float) -> Array:
        """Times between two others, s, from one of which to the next the motion is a polynomial."""
        ends = np.concatenate([piece.ts for piece in self.pieces[0]])
        return np.asarray(ends[(ends > begin) & (ends < end)])

    def columns(self, times: Array) -> Array:
        """Depth, velocity, force, and what leaves, f', at times (n,): SI, shape (4, n)."""
        striker, speed, end = self._states(times)
        leaving = np.zeros_like(times)
        for echoes in range(len(self.pieces[0])):
            ago = times - echoes * self.waves.delay if echoes else times
            struck, _, moved = self._states(np.maximum(ago, 0.0)) if echoes else (striker, speed, end)
            pressed = np.where(ago > 0.0, self.force(np.maximum(struck - moved, 0.0)), 0.0)
            leaving += self.waves.echo**echoes * pressed / self.waves.impedance
        return np.asarray([striker, speed, self.force(np.maximum(striker - end, 0.0)), leaving])

    def dents(self, times: Array) -> Array:
        """Depth of the dent, m, at times (n,)."""
        striker, _, end = self._states(times)
        return np.asarray(np.maximum(striker - end, 0.0))

    def _states(self, times: Array) -> Array:
        """x, x', u at times (n,), shape (3, n)."""
        pieces, found = self.pieces[0], np.empty((3, times.size))
        for index, here in _by_piece(self.starts, times):
            found[:, here] = pieces[index](times[here])
        return found
