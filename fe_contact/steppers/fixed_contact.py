"""The contact problem of a time step on a mesh that stays: which of its points touch, and how hard they press."""

from __future__ import annotations

from collections.abc import Sequence
from types import ModuleType

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.bodies.offer import Offer, Staying
from fe_contact.bodies.pressing import BEYOND
from fe_contact.contact.problem import ContactProblem, ContactSolution, Touching
from fe_contact.errors import ContactLost, ContactNotSettled, MemoryTooSmall
from fe_contact.settings import ENFORCEMENTS, Numerics
from fe_contact.steppers.coming_radius import coming_square
from fe_contact.steppers.march import Strike, Work
from fe_contact.steppers.steps import Step
from fe_contact.steppers.striker import Inertia
from lumped.schema.members import get

FIRST = 0.5  # share of the first overlap from which on places are guessed to touch
LEAST_KEPT = 0.05  # share of its area that a contact is guessed to keep over a step
WIDTH = 0.1  # of the first contact, in the mesh's unit, for the penalty alone
SECANTS, PRECISE = 20, 1e-13

Guesses = tuple[Touching, ...]


class FixedContact:
    """A striker over a surface: ``scale`` of the mesh, m; ``places`` and ``heights`` there of the striker, m, (q,)."""

    def __init__(self, strike: Strike, surface: Staying, numerics: Numerics) -> None:
        self.strike, self.surface, self.numerics = strike, surface, numerics
        self.enforcement: ModuleType = get(ENFORCEMENTS, numerics.enforcement)
        self.scale = surface.unit(numerics.contact_radius)
        self.places = surface.places(self.scale)
        self.heights = np.minimum(strike.height(self.places), BEYOND * self.scale)

    def overlap(self, depth: float) -> Array:
        """Of the undeformed surfaces at the points, (q,), m."""
        if self.strike.overlap is None:
            return depth - self.heights
        return np.maximum(self.strike.overlap(self.places, depth), -BEYOND * self.scale)

    def settled(self, offer: Offer, inertia: Inertia, steps: Sequence[Step]) -> tuple[ContactSolution, Work]:
        """Pressure of a body that offers this against a striker in a step after ``steps``.

        Raises ContactLost, ContactNotSettled, or MemoryTooSmall where the contact leaves the fine mesh.
        """
        guesses = self._guesses(offer, inertia, steps)
        settle = self._at_once if self.strike.overlap is None else self._by_secants
        return settle(offer, inertia, steps, guesses)

    def _at_once(
        self, offer: Offer, inertia: Inertia, steps: Sequence[Step], guesses: Guesses
    ) -> tuple[ContactSolution, Work]:
        """Every overlap grows as the depth does: the striker's give is one more compliance, the same everywhere."""
        operator = self.surface.operator
        overlap = offer.now * self.overlap(inertia.free_depth) + offer.past
        yielding = offer.now * inertia.give * self.scale ** (operator.dimension - 2) + operator.yielding
        solution = self._solved(offer, overlap, yielding, steps, guesses, inertia.state.time)
        return solution, Work(1, self.enforcement.SOLVES, solution.iterations)

    def _by_secants(
        self, offer: Offer, inertia: Inertia, steps: Sequence[Step], guesses: Guesses
    ) -> tuple[ContactSolution, Work]:
        """The same where a place's overlap does not: depth + give force = free depth."""
        operator, free_depth, give, time = self.surface.operator, inertia.free_depth, inertia.give, inertia.state.time
        depth, known = free_depth - give * (steps[-1].force if steps else 0.0), (0.0, -free_depth)
        solves, iterations = 0, 0
        for _ in range(SECANTS):
            free = offer.now * self.overlap(depth) + offer.past
            solution = self._solved(offer, free, 0.0, steps, guesses, time)
            solves, iterations = solves + self.enforcement.SOLVES, iterations + solution.iterations
            excess = depth + give * operator.force(self.scale, solution.pressure) - free_depth
            if abs(excess) <= PRECISE * free_depth:
                return solution, Work(1, solves, iterations)
            guesses = solution.sets
            slope = (excess - known[1]) / (depth - known[0])
            known, depth = (depth, excess), depth - excess / slope
        raise ContactNotSettled(time)

    def _guesses(self, offer: Offer, inertia: Inertia, steps: Sequence[Step]) -> Guesses:
        """Points that may touch in the coming step: those of the last one, and what its contact gains or loses."""
        if not steps:
            free = offer.now * self.overlap(inertia.free_depth) + offer.past
            return (free > FIRST * free.max(),)
        last, square = steps[-1], coming_square(steps, inertia.state.time + inertia.length)
        distance = np.abs(self.places)
        if square > last.radius**2:
            gained = (distance > last.radius) & (distance**2 < square)
            return tuple(touching | gained for touching in last.solution.sets)
        kept = distance**2 < max(square, LEAST_KEPT * last.radius**2)
        return tuple(touching & kept for touching in last.solution.sets)

    def _solved(
        self,
        offer: Offer,
        overlap: Array,
        yielding: float | Array,
        steps: Sequence[Step],
        guesses: Guesses,
        time: float,
    ) -> ContactSolution:
        """One contact problem, the penalty in units of the modulus over the last contact's radius."""
        radius = steps[-1].radius / self.scale if steps and steps[-1].radius > 0.0 else WIDTH
        problem = ContactProblem(offer.surface, overlap, self.numerics.penalty / radius, yielding)
        solution: ContactSolution = self.enforcement.enforce(problem, *guesses)
        if not solution.converged:
            raise ContactNotSettled(time)
        edge = solution.edge(self.places)
        if edge == 0.0:
            raise ContactLost(time)
        if not np.isfinite(edge) and self.surface.rim is None:
            raise MemoryTooSmall(self.places[-1])
        return solution
