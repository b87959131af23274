"""A mass that dents the end of a rod and sends waves down it: an ordinary equation between two echoes.

    m x'' = -F + m g,    u' = F/Z + 2 g',    F = force(x - u),    f' = F/Z + g',    g'(t) = echo f'(t - delay),

x of the striker, u of the rod's end; a delay equation, integrated echo by echo, exact to the integrator's tolerance.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from lumped.errors import NotReached
from lumped.numbers import Real
from lumped.solvers.rod.waves import Waves

Array = NDArray[np.float64]
MOST_ECHOES = 100
LONGEST, FIRST = 0.25, 4e-3  # steps, as `longest` says, and the first one over that
ABSOLUTE = 1e-2  # over the relative tolerance, in units of the elastic impact
STRIKER, SPEED, END = range(3)


@dataclass(frozen=True)
class RodScales:
    """Depth, m, and time, s, of the elastic impact on a body that sends no waves."""

    depth: float
    time: float


class _BetweenEchoes(Protocol):
    """The states x, x', u between two echoes, at the times of an integrator's steps `ts`, s, and at any others."""

    ts: Array

    def __call__(self, t: Real) -> Array: ...


@dataclass(frozen=True)
class TippedImpact:
    """One impact: ``force`` over the dent's depth, N and m; mass, kg; velocity, m/s; gravity along the motion, m/s2.

    Followed until ``until``, s, each step to ``rtol``, and no longer than a share ``longest`` of the elastic impact and
    of the time between two echoes.
    """

    waves: Waves
    force: Callable[[Real], Real]
    mass: float
    velocity: float
    gravity: float
    until: float
    scales: RodScales
    rtol: float
    longest: float = LONGEST

    @cached_property
    def pieces(self) -> tuple[tuple[_BetweenEchoes, ...], float, bool]:
        """A dense answer an echo, when contact ends or is no longer followed, s, and whether it ended.

        Raises NotReached.
        """
        from scipy.integrate import solve_ivp

        longest = self.longest * min(self.scales.time, self.waves.delay)
        state, found, begin = np.array([0.0, self.velocity, 0.0]), list[_BetweenEchoes](), 0.0
        tolerances = self.rtol * ABSOLUTE * np.array([self.scales.depth, self.velocity, self.scales.depth])

        def parted(_: float, y: Array) -> float:
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
        raise NotReached(f"rod: more than {MOST_ECHOES} echoes; accepted: a heavier rod, an earlier motion.end_time")

    def _rates(self, before: list[_BetweenEchoes], begin: float) -> Callable[[float, Array], list[float]]:
        """Rates between two echoes, ``before`` what was found of the time until ``begin``."""
        impedance, delay = self.waves.impedance, self.waves.delay
        chain = before[::-1]

        def came(time: float) -> float:
            """g': what pressed at every delay before now, the echo's sign to its power."""
            total, weight = 0.0, 1.0
            for count, answer in enumerate(chain, 1):
                y = answer(time - count * delay)
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
        starts, pieces = self.starts, self.pieces[0]
        place = np.clip(np.searchsorted(starts, times, side="right") - 1, 0, len(pieces) - 1)
        found = np.empty((3, times.size))
        for index in np.unique(place):
            here = place == index
            found[:, here] = pieces[index](times[here])
        return found
