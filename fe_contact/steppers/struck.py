"""What is struck: what the march and its error budget ask of it, and what all bodies with a mesh share.

Step on a body with lengths of its own: the mesh stays, the contact moves over it. Its contact problem says which of its
points touch, and how hard they press.

Edge of a contact that recedes: where the gap behind it begins, told as the pressure that would have kept it closed.
An elastic gap grows like the power 3/2 of the distance from the edge, which tells where that is. Behind an edge that
moves a gap is the younger the nearer it lies, and what has that power is not the gap g but

    E_inf g + sum_k E_k z_k + viscosity dg/dt ,    dz_k/dt = dg/dt - z_k/tau_k ,

over the time for which each place has been open: how far the elastic displacement of the pressure, smooth but for its
present edge, lies from what holds the surface on the striker (Ting 1966, doi:10.1115/1.3625192).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.bodies.memory import StepLaw, SurfaceMemory, step_law
from fe_contact.bodies.modes import Condensed
from fe_contact.bodies.offer import Body, Memory, Offer
from fe_contact.bodies.pressing import BEYOND, half_width, in_reach
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.contact.problem import ContactProblem, ContactSolution, Touching
from fe_contact.errors import ContactLost, ContactNotSettled, MemoryTooSmall
from fe_contact.schemes.base import SCHEMES, MemoryScheme
from fe_contact.settings import Numerics
from fe_contact.steppers.steps import (
    Inertia,
    Snapshot,
    State,
    Step,
    Stepping,
    Strike,
    Work,
    coming_square,
    radius_time,
)
from lumped.materials import Relaxation


class Struck(Protocol):
    """What is struck, with one setting of everything: ``follows_contact`` where its mesh does so.

    ``factorizations`` and back-substitutions, ``solves``, that it took; unknowns of its meshes.
    """

    @property
    def follows_contact(self) -> bool: ...

    @property
    def factorizations(self) -> int: ...

    @property
    def solves(self) -> int: ...

    @property
    def degrees_of_freedom(self) -> int: ...

    def stepper(self, strike: Strike, numerics: Numerics, expected: Sequence[float] | Array) -> Stepping:
        """What takes its time steps: ``expected`` radii, m, of a like march."""

    def felt(self, snapshot: Snapshot) -> tuple[Array, Array]:
        """Places on its surface, m, and the pressure there that it feels in a step, Pa, each (n,)."""


class Deformable(Condensed):
    """A struck body before the impact: ``operator`` of one elastic body on its mesh, for places, weights and scale.

    The contract of :class:`Struck`, of which only what differs has to be said.
    """

    if TYPE_CHECKING:  # members have it as a field or as a property

        @property
        def follows_contact(self) -> bool: ...

    @property
    def rim(self) -> float | None:
        """Where all contacts end, m, if the body is loaded no farther."""
        return None

    def body(self, relaxation: Relaxation, scheme: MemoryScheme, scale: float) -> Body:
        """The body with a contact modulus E*(t), Pa, marched by a scheme, on a mesh whose unit is ``scale``, m."""
        raise NotImplementedError

    @property
    def degrees_of_freedom(self) -> int:
        """Unknowns of the one mesh."""
        return self.operator.degrees_of_freedom

    def unit(self, contact_radius: float) -> float:
        """The mesh's unit of length, m, where contacts up to this radius, m, are expected."""
        return contact_radius

    def places(self, unit: float) -> Array:
        """Distance of the quadrature points from the first touch as the striker's profile counts it, m; (q,)."""
        return unit * self.operator.points

    def corners(self, contact_radius: float) -> Array:
        """Where elements meet on the surface, m, ascending, as :meth:`places` are counted; see :meth:`unit`."""
        return np.interp(self.operator.corners, self.operator.points, self.places(self.unit(contact_radius)))

    def stepper(self, strike: Strike, numerics: Numerics, expected: Sequence[float] | Array) -> Stepping:
        """Steps on the mesh that stays, for which no radius has to be expected."""
        return FixedStepper(strike, self, numerics)

    def felt(self, snapshot: Snapshot) -> tuple[Array, Array]:
        """At the nodes, without the roughness that the shape functions do not see."""
        operator = self.operator
        nodes = float(snapshot.radii[0] / operator.points[0]) * operator.nodes[: operator.trace.shape[1]]
        return nodes, operator.projected(snapshot.pressure)


FIRST = 0.5  # share of the first overlap from which on places are guessed to touch
LEAST_KEPT = 0.05  # share of its area that a contact is guessed to keep over a step
WIDTH = 0.1  # of the first contact, in the mesh's unit, for the penalty alone
SECANTS, PRECISE = 20, 1e-13  # work: of the depth in one step; rounding: what it may miss, over the free depth
Guesses = tuple[Touching, ...]


class Remembered(NamedTuple):
    """What the body remembers, which is its own affair, and, once the contact recedes, where it has opened."""

    body: Any
    opened: SurfaceMemory | None = None


class FixedStepper:
    """Takes steps on one mesh: the contract of :class:`fe_contact.steppers.steps.Stepping`."""

    shortest = 2e-4  # the trend bends more than on a mesh that follows the contact
    first_force = 0.0

    def __init__(self, strike: Strike, surface: Deformable, numerics: Numerics) -> None:
        self.strike, self.surface, self.numerics = strike, surface, numerics
        self.scheme = SCHEMES.get(numerics.scheme)
        self.contact = FixedContact(strike, surface, numerics, self.scheme)
        self.scale, self.places, self.heights = self.contact.scale, self.contact.places, self.contact.heights
        self.body = surface.body(strike.relaxation, self.scheme, self.scale)

    def touch(self) -> State:
        """The striker at the surface, at rest or with what it remembers."""
        strike = self.strike
        return State(0.0, strike.depth, strike.velocity, 0.0, Remembered(strike.memory or self.body.at_rest()))

    def remembered(self, memory: Remembered) -> Memory:
        """The surface's, on a body which has one for it."""
        return memory.body

    def standing(self) -> int:
        """The node at the first touch."""
        operator = self.surface.operator
        return int(np.abs(operator.nodes[: operator.trace.shape[1]]).argmin())

    def clearance(self, surface: SurfaceMemory, depth: float) -> Array:
        """Gap of the surfaces at the quadrature points, m."""
        return np.asarray(self.body.displacement(surface) - self.contact.overlap(depth))

    def step(self, state: State, steps: Sequence[Step], length: float) -> Step:
        """The step of a length, s, from a state reached by ``steps``.

        Raises ContactLost, ContactNotSettled, or MemoryTooSmall where the contact leaves the fine mesh.
        """
        offer = self.body.offer(state.memory.body, length)
        inertia = Inertia.of(self.strike, self.scheme, state, length)
        solution, work = self.contact.settled(offer, inertia, steps)
        force = self.surface.operator.force(self.scale, solution.pressure)
        memory, axis = self.body.after(state.memory.body, offer, solution.pressure)
        after = inertia.moved(force, Remembered(memory))
        radius, found_at, ended = self._ended(state, after, steps, solution, length)
        return Step(length, ended, force, radius, found_at, axis, solution, self.scale, work)

    def _ended(
        self, before: State, after: State, steps: Sequence[Step], solution: ContactSolution, length: float
    ) -> tuple[float, float, State]:
        """Contact radius, m, when that was, s, and the state with what has opened.

        Growing, the contact has its radius at the end of the step; receding, where the scheme samples the pressure.
        """
        sampled = before.time + length * self.scheme.sample
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
        gap = self.body.displacement(state.memory.body) - self.contact.overlap(state.depth)
        touching = solution.signed_pressure > 0.0
        return np.where(touching, 0.0, gap - _median(gap[touching]))

    def snapshots(self, steps: Sequence[Step]) -> tuple[Snapshot, ...]:
        """Places and pressure at the quadrature points."""
        early = 1 - self.scheme.sample
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

    def stored(self, memory: Memory) -> float:
        """Elastic energy, J."""
        return self.body.stored(memory.body)

    def heat_and_loss(self, before: Memory, after: Memory, length: float) -> tuple[float, float]:
        """Heat of a step of a length, s; of the work in it what the scheme leaves unaccounted for; J."""
        return self.body.heat_and_loss(before.body, after.body, length)

    def between(self, before: State, step: Step) -> float:
        """Work of the striker in a step that does not reach the body, J: of the penalty, and at a gap that opens."""
        operator, after = self.surface.operator, step.state
        sunk = self.body.displacement(after.memory.body) - self.body.displacement(before.memory.body)
        reached = self.scale ** (operator.dimension - 2) * float(operator.weights @ (step.solution.pressure * sunk))
        return step.force * (after.depth - before.depth) - reached


def _median(values: Array) -> float:
    """Of some values (n,), as numpy's, which asks first what it was given."""
    ordered = np.sort(values)
    return 0.5 * float(ordered[(ordered.size - 1) // 2] + ordered[ordered.size // 2])


def just_open(gap: Array, branches: int) -> SurfaceMemory:
    """What is open, (q,), m, as the contact turns: the edge has left it only for a moment, and all springs feel it."""
    gap = np.maximum(gap, 0.0)
    return SurfaceMemory(np.ones_like(gap), gap[None], np.tile(gap, (branches, 1, 1)))


def opened(memory: SurfaceMemory, law: StepLaw, gap: Array) -> tuple[SurfaceMemory, Array]:
    """The memory after a step that leads to a gap (q,), m, and gap times modulus in the step, (q,), Pa m."""
    now = np.maximum(gap, 0.0)[None]
    return memory.advanced(law, now), (law.now * now + memory.carried(law))[0]


class FixedContact:
    """A striker over a surface: ``scale`` of the mesh, m; ``places`` and ``heights`` there of the striker, m, (q,)."""

    def __init__(self, strike: Strike, surface: Deformable, numerics: Numerics, scheme: MemoryScheme) -> None:
        self.strike, self.surface, self.numerics, self.scheme = strike, surface, numerics, scheme
        self.enforcement = ENFORCEMENTS.get(numerics.enforcement)
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
        return solution, Work(1, self.enforcement.solves, solution.iterations)

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
            solves, iterations = solves + self.enforcement.solves, iterations + solution.iterations
            excess = depth + give * operator.force(self.scale, solution.pressure) - free_depth
            if abs(excess) <= PRECISE * free_depth:
                return solution, Work(1, solves, iterations)
            guesses = solution.sets
            slope = (excess - known[1]) / (depth - known[0])
            known, depth = (depth, excess), depth - excess / slope
        raise ContactNotSettled(time, self.enforcement.settling)

    def _guesses(self, offer: Offer, inertia: Inertia, steps: Sequence[Step]) -> Guesses:
        """Points that may touch in the coming step: those of the last one, and what its contact gains or loses."""
        if not steps:
            free = offer.now * self.overlap(inertia.free_depth) + offer.past
            return (free > FIRST * free.max(),)
        last, state = steps[-1], inertia.state
        square = coming_square(steps, radius_time(self.scheme, state.velocity, state.time, inertia.length))
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
        free = overlap if self.surface.operator.watched is not None else in_reach(overlap)  # a datum comes up
        problem = ContactProblem(offer.surface, free, self.numerics.penalty / radius, yielding)
        solution: ContactSolution = self.enforcement.enforce(problem, *guesses)
        if not solution.converged:
            raise ContactNotSettled(time, self.enforcement.settling)
        edge = solution.edge(self.places)
        if edge == 0.0:
            raise ContactLost(time)
        if not np.isfinite(edge) and self.surface.rim is None:
            raise MemoryTooSmall(self.places[-1])
        return solution
