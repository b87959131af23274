"""One time step of an impact on a body with lengths of its own: the mesh stays, the contact moves over it."""

from __future__ import annotations

from collections.abc import Sequence
from types import ModuleType
from typing import Any

import numpy as np

from fe_contact.bodies.offer import Deformable, Offer
from fe_contact.contact import ContactProblem, ContactSolution, Touching
from fe_contact.errors import ContactLost, ContactNotSettled, MemoryTooSmall
from fe_contact.forms import Array
from fe_contact.march import Strike, Work
from fe_contact.numerics import ENFORCEMENTS, SCHEMES, Numerics
from fe_contact.pressing import contact_end
from fe_contact.steps import State, Step
from lumped.members import get

BEYOND = 1e3  # overlap, in reference radii, that radii past the striker's rim lack
FIRST = 0.1  # share of the contact zone that is guessed to touch first
SECANTS, PRECISE = 20, 1e-13


class FixedStepper:
    """Takes steps on one mesh: the interface of :class:`fe_contact.stepping.Stepper`."""

    def __init__(self, strike: Strike, surface: Deformable, numerics: Numerics, accounted: bool) -> None:
        self.strike, self.surface, self.numerics = strike, surface, numerics
        self.scheme: ModuleType = get(SCHEMES, numerics.scheme)
        self.enforcement: ModuleType = get(ENFORCEMENTS, numerics.enforcement)
        self.scale = numerics.contact_radius
        self.body = surface.body(strike.relaxation, self.scheme, self.scale)
        self.heights = np.minimum(strike.height(self.scale * surface.operator.points), BEYOND * self.scale)
        self.accounted = accounted

    def touch(self) -> State:
        """The striker at the surface at rest."""
        return State(0.0, 0.0, self.strike.velocity, 0.0, self.body.at_rest())

    def step(self, state: State, steps: Sequence[Step], length: float) -> Step:
        """The step of a length, s, from a state reached by ``steps``.

        Raises ContactLost, ContactNotSettled, or MemoryTooSmall where the contact leaves the fine mesh.
        """
        strike, operator = self.strike, self.surface.operator
        offer = self.body.offer(state.memory, length)
        lever = self.scheme.LEVER * length**2
        free_depth = state.depth + length * state.velocity + lever * strike.gravity
        settle = self._settled if strike.overlap is None else self._settled_by_secants
        solution, work = settle(offer, free_depth, lever / strike.mass, steps, state.time)
        edge = contact_end(operator.points, solution)
        force = operator.force(self.scale, solution.pressure)
        memory, axis = self.body.after(state.memory, offer, solution.pressure)
        moved = State(
            time=strike.end_time if length >= strike.end_time - state.time else state.time + length,
            depth=free_depth - lever * force / strike.mass,
            velocity=state.velocity + length * (strike.gravity - force / strike.mass),
            impulse=state.impulse + length * force,
            memory=memory,
        )
        found_at = state.time + length * (1.0 if moved.velocity > 0 else self.scheme.SAMPLE)
        return Step(length, moved, force, self.scale * edge, found_at, axis, solution, self.scale, work)

    def modulus(self, length: float) -> float:
        """Contact modulus against new strain in a step of a length, s; Pa."""
        return self.body.modulus(length)

    def stored(self, memory: Any) -> float:
        """Elastic energy, J."""
        return self.body.stored(memory)

    def dissipated(self, before: Any, after: Any, length: float) -> float:
        """Heat of a step of a length, s; J."""
        return self.body.dissipated(before, after, length)

    def _settled(
        self, offer: Offer, free_depth: float, give: float, steps: Sequence[Step], time: float
    ) -> tuple[ContactSolution, Work]:
        """Contact with the striker that retreats by ``give``, m/N, and every overlap with it."""
        overlap = offer.now * (free_depth - self.heights) + offer.past
        yielding = offer.now * give * self.scale ** (self.surface.operator.dimension - 2)
        solution = self._solved(offer, overlap, yielding, steps[-1] if steps else None, time)
        return solution, Work(1, self.enforcement.SOLVES, solution.iterations)

    def _settled_by_secants(
        self, offer: Offer, free_depth: float, give: float, steps: Sequence[Step], time: float
    ) -> tuple[ContactSolution, Work]:
        """The same where a place's overlap does not grow as the depth does: depth + give force = free depth."""
        overlap, operator = self.strike.overlap, self.surface.operator
        assert overlap is not None
        arcs, last = self.scale * operator.points, steps[-1] if steps else None
        depth, known, solves, iterations = free_depth - give * (last.force if last else 0.0), (0.0, -free_depth), 0, 0
        for _ in range(SECANTS):
            free = offer.now * np.maximum(overlap(arcs, depth), -BEYOND * self.scale) + offer.past
            solution = self._solved(offer, free, 0.0, last, time)
            solves, iterations = solves + self.enforcement.SOLVES, iterations + solution.iterations
            excess = depth + give * operator.force(self.scale, solution.pressure) - free_depth
            if abs(excess) <= PRECISE * free_depth:
                return solution, Work(1, solves, iterations)
            slope = (excess - known[1]) / (depth - known[0])
            known, depth = (depth, excess), depth - excess / slope
        raise ContactNotSettled(time)

    def _solved(self, offer: Offer, overlap: Array, yielding: float, last: Step | None, time: float) -> ContactSolution:
        points = self.surface.operator.points
        guesses: tuple[Touching, ...] = last.solution.sets if last else (points < FIRST * points[-1],)
        radius = last.radius / self.scale if last and last.radius > 0.0 else FIRST
        problem = ContactProblem(offer.surface, overlap, self.numerics.penalty / radius, yielding)
        solution: ContactSolution = self.enforcement.enforce(problem, *guesses)
        if not solution.converged:
            raise ContactNotSettled(time)
        edge = solution.edge(points)
        if edge == 0.0:
            raise ContactLost(time)
        if not np.isfinite(edge):
            raise MemoryTooSmall(self.scale * points[-1])
        return solution
