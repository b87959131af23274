"""One time step of an impact on a body with lengths of its own: the mesh stays, the contact moves over it."""

from __future__ import annotations

from collections.abc import Sequence
from types import ModuleType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fe_contact.bodies.memory import SurfaceMemory, step_law
from fe_contact.bodies.offer import Offer
from fe_contact.contact import ContactProblem, ContactSolution, Touching
from fe_contact.errors import ContactLost, ContactNotSettled, MemoryTooSmall
from fe_contact.forms import Array
from fe_contact.march import Snapshot, Strike, Work
from fe_contact.numerics import ENFORCEMENTS, SCHEMES, Numerics
from fe_contact.opening import just_open, opened
from fe_contact.pressing import half_width
from fe_contact.stepping import extrapolated
from fe_contact.steps import State, Step
from lumped.members import get

if TYPE_CHECKING:
    from fe_contact.bodies.struck import Deformable

BEYOND = 1e3  # overlap, in reference radii, that radii past the striker's rim lack
FIRST = 0.5  # share of the first overlap from which on places are guessed to touch
LEAST_KEPT = 0.05  # share of its area that a contact is guessed to keep over a step
WIDTH = 0.1  # of the first contact, in the mesh's unit, for the penalty alone
SECANTS, PRECISE = 20, 1e-13

Guesses = tuple[Touching, ...]


class Remembered(NamedTuple):
    """What the body remembers, which is its own affair, and, once the contact recedes, where it has opened."""

    body: Any
    opened: SurfaceMemory | None = None


class FixedStepper:
    """Takes steps on one mesh: the contract of :class:`fe_contact.steps.Stepping`."""

    shortest = 2e-4  # the trend bends more than on a mesh that breathes
    first_force = 0.0

    def __init__(self, strike: Strike, surface: Deformable, numerics: Numerics, accounted: bool) -> None:
        self.strike, self.surface, self.numerics = strike, surface, numerics
        self.scheme: ModuleType = get(SCHEMES, numerics.scheme)
        self.enforcement: ModuleType = get(ENFORCEMENTS, numerics.enforcement)
        self.scale = surface.unit(numerics.contact_radius)
        self.body = surface.body(strike.relaxation, self.scheme, self.scale)
        self.places = surface.places(self.scale)
        self.heights = np.minimum(strike.height(self.places), BEYOND * self.scale)
        self.accounted = accounted

    def touch(self) -> State:
        """The striker at the surface, at rest or with what it remembers."""
        strike = self.strike
        return State(0.0, strike.depth, strike.velocity, 0.0, Remembered(strike.memory or self.body.at_rest()))

    def remembered(self, memory: Remembered) -> Any:
        """The surface's, on a body which has one for it."""
        return memory.body

    def standing(self) -> int:
        """The node at the first touch."""
        operator = self.surface.operator
        return int(np.abs(operator.nodes[: operator.trace.shape[1]]).argmin())

    def clearance(self, surface: SurfaceMemory, depth: float) -> Array:
        """Gap of the surfaces at the quadrature points, m."""
        return np.asarray(self.body.displacement(surface) - self._overlap(depth))

    def step(self, state: State, steps: Sequence[Step], length: float) -> Step:
        """The step of a length, s, from a state reached by ``steps``.

        Raises ContactLost, ContactNotSettled, or MemoryTooSmall where the contact leaves the fine mesh.
        """
        strike, operator = self.strike, self.surface.operator
        offer = self.body.offer(state.memory.body, length)
        lever = self.scheme.LEVER * length**2
        free_depth = state.depth + length * state.velocity + lever * strike.gravity
        settle = self._settled if strike.overlap is None else self._settled_by_secants
        guesses = self._guesses(offer, steps, state.time + length, free_depth)
        solution, work = settle(offer, free_depth, lever / strike.mass, steps, guesses, state.time)
        force = operator.force(self.scale, solution.pressure)
        memory, axis = self.body.after(state.memory.body, offer, solution.pressure)
        moved = State(
            time=strike.end_time if length >= strike.end_time - state.time else state.time + length,
            depth=free_depth - lever * force / strike.mass,
            velocity=state.velocity + length * (strike.gravity - force / strike.mass),
            impulse=state.impulse + length * force,
            memory=Remembered(memory),
        )
        radius, found_at, ended = self._ended(state, moved, steps, solution, length)
        return Step(length, ended, force, radius, found_at, axis, solution, self.scale, work)

    def _ended(
        self, before: State, after: State, steps: Sequence[Step], solution: ContactSolution, length: float
    ) -> tuple[float, float, State]:
        """Contact radius, m, when that was, s, and the state with what has opened.

        Growing, the contact has its radius at the end of the step; receding, where the scheme samples the pressure.
        """
        sampled = before.time + length * self.scheme.SAMPLE
        if self.surface.rim is not None:
            return self.surface.rim, sampled, after
        if after.velocity > 0.0:
            gap = self._gap(after, solution)
            return half_width(self.places, solution.signed_pressure, gap, height=self.heights), after.time, after
        radius, after = self._receded(before, after, steps, solution, length)
        return radius, sampled, after

    def _receded(
        self, before: State, after: State, steps: Sequence[Step], solution: ContactSolution, length: float
    ) -> tuple[float, State]:
        """Contact radius, m, where the scheme samples the pressure, and the state with what has opened."""
        law = step_law(self.strike.relaxation, self.scheme, length)
        known = before.memory.opened or just_open(self._gap(before, solution), len(law.decay))
        memory, stress = opened(known, law, self._gap(after, solution))
        widest = max((earlier.radius for earlier in steps), default=np.inf)
        radius = half_width(self.places, solution.signed_pressure, stress, widest, self.heights)
        return radius, after._replace(memory=after.memory._replace(opened=memory))

    def _gap(self, state: State, solution: ContactSolution) -> Array:
        """Of the deformed surfaces, (q,), m.

        A datum that moves lifts all places alike: where the surfaces touch there is no gap.
        """
        gap = self.body.displacement(state.memory.body) - self._overlap(state.depth)
        touching = solution.signed_pressure > 0.0
        return np.where(touching, 0.0, gap - np.median(gap[touching]))

    def _overlap(self, depth: float) -> Array:
        """Of the undeformed surfaces at the points, (q,), m."""
        if self.strike.overlap is None:
            return depth - self.heights
        return np.maximum(self.strike.overlap(self.places, depth), -BEYOND * self.scale)

    def snapshots(self, steps: Sequence[Step]) -> tuple[Snapshot, ...]:
        """Places and pressure at the quadrature points."""
        early = 1 - self.scheme.SAMPLE
        return tuple(
            Snapshot(
                time=step.state.time - early * step.length,
                force=step.force,
                contact_radius=step.radius,
                radii=self.places,
                pressure=step.solution.pressure / self.scale,
            )
            for step in steps
        )

    def stored(self, memory: Any) -> float:
        """Elastic energy, J."""
        return self.body.stored(memory.body)

    def dissipated(self, before: Any, after: Any, length: float) -> float:
        """Heat of a step of a length, s; J."""
        return self.body.dissipated(before.body, after.body, length)

    def springs(self, step: Step) -> float:
        """What the penalty's springs hold, J."""
        operator = self.surface.operator
        stiffness = self.numerics.penalty * self.scale / step.radius * self.body.modulus(step.length)
        squares = float(operator.weights @ step.solution.pressure**2)
        return 0.5 * self.scale ** (operator.dimension - 2) * squares / stiffness

    def _settled(
        self, offer: Offer, free_depth: float, give: float, steps: Sequence[Step], guesses: Guesses, time: float
    ) -> tuple[ContactSolution, Work]:
        """Contact with the striker that retreats by ``give``, m/N, and every overlap with it."""
        overlap = offer.now * self._overlap(free_depth) + offer.past
        operator = self.surface.operator
        yielding = offer.now * give * self.scale ** (operator.dimension - 2) + operator.yielding
        solution = self._solved(offer, overlap, yielding, steps[-1] if steps else None, guesses, time)
        return solution, Work(1, self.enforcement.SOLVES, solution.iterations)

    def _settled_by_secants(
        self, offer: Offer, free_depth: float, give: float, steps: Sequence[Step], guesses: Guesses, time: float
    ) -> tuple[ContactSolution, Work]:
        """The same where a place's overlap does not grow as the depth does: depth + give force = free depth."""
        operator, last = self.surface.operator, steps[-1] if steps else None
        depth, known, solves, iterations = free_depth - give * (last.force if last else 0.0), (0.0, -free_depth), 0, 0
        for _ in range(SECANTS):
            free = offer.now * self._overlap(depth) + offer.past
            solution = self._solved(offer, free, 0.0, last, guesses, time)
            solves, iterations = solves + self.enforcement.SOLVES, iterations + solution.iterations
            excess = depth + give * operator.force(self.scale, solution.pressure) - free_depth
            if abs(excess) <= PRECISE * free_depth:
                return solution, Work(1, solves, iterations)
            guesses = solution.sets
            slope = (excess - known[1]) / (depth - known[0])
            known, depth = (depth, excess), depth - excess / slope
        raise ContactNotSettled(time)

    def _guesses(self, offer: Offer, steps: Sequence[Step], until: float, free_depth: float) -> Guesses:
        """Points that may touch in the coming step: those of the last one, and what its contact gains or loses."""
        if not steps:
            free = offer.now * self._overlap(free_depth) + offer.past
            return (free > FIRST * free.max(),)
        known = [(0.0, 0.0), *((step.radius_time, step.radius**2) for step in steps[-3:])][-3:]
        last, square = steps[-1], extrapolated(known, until)
        distance = np.abs(self.places)
        if square > last.radius**2:
            gained = (distance > last.radius) & (distance**2 < square)
            return tuple(touching | gained for touching in last.solution.sets)
        kept = distance**2 < max(square, LEAST_KEPT * last.radius**2)
        return tuple(touching & kept for touching in last.solution.sets)

    def _solved(
        self, offer: Offer, overlap: Array, yielding: float | Array, last: Step | None, guesses: Guesses, time: float
    ) -> ContactSolution:
        places = self.places
        radius = last.radius / self.scale if last and last.radius > 0.0 else WIDTH
        problem = ContactProblem(offer.surface, overlap, self.numerics.penalty / radius, yielding)
        solution: ContactSolution = self.enforcement.enforce(problem, *guesses)
        if not solution.converged:
            raise ContactNotSettled(time)
        edge = solution.edge(places)
        if edge == 0.0:
            raise ContactLost(time)
        if not np.isfinite(edge) and self.surface.rim is None:
            raise MemoryTooSmall(places[-1])
        return solution
