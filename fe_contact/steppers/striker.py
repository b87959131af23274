"""The rigid striker in a time step: where it would be free of force, and where the force leaves it."""

from __future__ import annotations

from typing import NamedTuple

from fe_contact.bodies.offer import Memory
from fe_contact.schemes.base import MemoryScheme
from fe_contact.steppers.march import Strike
from fe_contact.steppers.steps import State


class Inertia(NamedTuple):
    """All that contact sees of the striker in a step of a ``length``, s, from a state: depth = free depth - give force.

    ``lever``, s2: times an acceleration, the way that it makes within the step, by the scheme.
    """

    strike: Strike
    state: State
    length: float
    lever: float

    @classmethod
    def of(cls, strike: Strike, scheme: MemoryScheme, state: State, length: float) -> Inertia:
        """In a step of the scheme."""
        return cls(strike, state, length, scheme.lever * length**2)

    @property
    def free_depth(self) -> float:
        """Depth at the end of the step without a force, m."""
        return self.state.depth + self.length * self.state.velocity + self.lever * self.strike.gravity

    @property
    def give(self) -> float:
        """How far a force pushes it back, m/N."""
        return float(self.lever / self.strike.mass)

    def depth(self, force: float) -> float:
        """At the end of the step under a force, N; m."""
        return float(self.free_depth - self.lever * force / self.strike.mass)

    def moved(self, force: float, memory: Memory) -> State:
        """The state after the step under a force, N, of a body that then has this memory."""
        strike, state, length = self.strike, self.state, self.length
        return State(
            time=strike.end_time if length >= strike.end_time - state.time else state.time + length,
            depth=self.depth(force),
            velocity=state.velocity + length * (strike.gravity - force / strike.mass),
            impulse=state.impulse + length * force,
            memory=memory,
        )
