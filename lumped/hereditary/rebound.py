"""Ting's rebound: the contact shrinks back over the places that it passed, doi 10.1115/1.3625192.

At time t the contact radius is what it was at an earlier time t1(t), where int_{t1}^t E(t-s) d depth(s) = 0,
and the force is F(t) = int_0^{t1} E(t-s) dy(s).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.hereditary.approach import Approach
from lumped.hereditary.problem import Hereditary
from lumped.hereditary.solve import Path, Settings, follow

Array = NDArray[np.float64]
ROOT_STEPS = 100
NO_VELOCITY = 1e-200


@dataclass(frozen=True)
class Rebound:
    """The rebound that follows an approach. States: depth, velocity, work done, memories x_k of the depth."""

    problem: Hereditary
    inward: Approach

    def follow(self, end_time: float, settings: Settings) -> Path:
        """The path until t1 = 0 (event 0), a second approach (1) or `end_time`. Raises NotReached."""
        k = self.problem.terms
        turn = self.inward.path.at(self.inward.path.end)
        start = np.concatenate([turn[:3], turn[3 + k :]])
        start[1] = 0.0
        nearby = np.array([self.inward.end])

        def rate(time: float, state: Array) -> Array:
            """The time derivative of one state; where t1 was a moment ago is a good guess for it."""
            nonlocal nearby
            nearby = self.same_edge(np.array([time]), state[:, None], nearby)
            return self._rate(time, state, nearby)

        events = [lambda t, state: float(self.lack(state, np.zeros(3 + 2 * k), 0.0 * self.problem.rates)),
                  lambda t, state: 1e-12 - float(state[1])]  # fmt: skip
        return follow(rate, (self.inward.end, end_time), start, events, settings)

    def _rate(self, time: float, state: Array, earlier: Array) -> Array:
        force = float(self._pressed(np.array([time]), earlier)[0][0])
        change = np.empty_like(state)
        change[0] = state[1]
        change[1] = self.problem.gravity - force
        change[2] = force * state[1]
        change[3:] = state[1] - state[3:] * self.problem.rates
        return change

    def pressed(self, time: Array, state: Array) -> tuple[Array, Array]:
        """F, and the depth at t1, which had the same contact radius; at times (n,) and states (3 + K, n)."""
        guess = np.clip(2.0 * self.inward.end - time, 0.0, self.inward.end)
        return self._pressed(time, self.same_edge(time, state, guess))

    def _pressed(self, time: Array, earlier: Array) -> tuple[Array, Array]:
        k = self.problem.terms
        then = self.inward.state(earlier)
        fade = np.exp(-np.outer(self.problem.rates, time - earlier))
        memory = self.problem.stiffnesses @ (fade * then[3 : 3 + k])
        return np.asarray(self.problem.modulus.equilibrium * self.problem.load(then[0]) + memory), then[0]

    def lack(self, state: Array, then: Array, fade: Array) -> Array:
        """The integral that vanishes at t1, int_{t1}^t E(t-s) d depth(s).

        `state` has the shape (3 + K, ...), `then` is the state of the approach at t1, `fade` is exp(-(t-t1)/tau_k).
        """
        modulus, k = self.problem.modulus, self.problem.terms
        memory = self.problem.stiffnesses @ (state[3:] - fade * then[3 + k :])
        return np.asarray(modulus.equilibrium * (state[0] - then[0]) + memory + modulus.viscosity * state[1])

    def same_edge(self, time: Array, state: Array, guess: Array) -> Array:
        """t1 at times (n,), from a guess by Newton steps inside a bracket; zero once contact has closed."""
        turn = self.inward.end
        low, high = np.zeros_like(time), np.full_like(time, turn)
        t1 = guess
        for _ in range(ROOT_STEPS):
            then = self.inward.state(t1)
            fade = np.exp(-np.outer(self.problem.rates, time - t1))
            lack = self.lack(state, then, fade)
            low, high = np.where(lack > 0.0, t1, low), np.where(lack > 0.0, high, t1)
            stiffness = self.problem.modulus.equilibrium + self.problem.stiffnesses @ fade
            slope = stiffness * np.maximum(then[1], NO_VELOCITY)
            new = t1 + lack / slope
            new = np.where((new <= low) | (new >= high), 0.5 * (low + high), new)
            # A lack below rounding leaves t1 where it is: at the turn itself any t1 nearby will do.
            new = np.where(np.abs(lack) <= 1e-16 * stiffness * state[0], t1, new)
            if np.all(np.abs(new - t1) <= 1e-15 * turn):
                return new
            t1 = new
        return t1
