"""One time step of an impact on a body with lengths of its own: the mesh stays, the contact moves over it."""

from __future__ import annotations

from collections.abc import Sequence
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.bodies.memory import SurfaceMemory, step_law
from fe_contact.bodies.offer import Staying
from fe_contact.bodies.pressing import half_width
from fe_contact.contact.problem import ContactSolution
from fe_contact.settings import SCHEMES, Numerics
from fe_contact.steppers.fixed_contact import FixedContact
from fe_contact.steppers.march import Snapshot, Strike
from fe_contact.steppers.opening import just_open, opened
from fe_contact.steppers.steps import State, Step
from fe_contact.steppers.striker import Inertia
from lumped.schema.members import get


class Remembered(NamedTuple):
    """What the body remembers, which is its own affair, and, once the contact recedes, where it has opened."""

    body: Any
    opened: SurfaceMemory | None = None


class FixedStepper:
    """Takes steps on one mesh: the contract of :class:`fe_contact.steppers.steps.Stepping`."""

    shortest = 2e-4  # the trend bends more than on a mesh that breathes
    first_force = 0.0

    def __init__(self, strike: Strike, surface: Staying, numerics: Numerics) -> None:
        self.strike, self.surface, self.numerics = strike, surface, numerics
        self.scheme: ModuleType = get(SCHEMES, numerics.scheme)
        self.contact = FixedContact(strike, surface, numerics)
        self.scale, self.places, self.heights = self.contact.scale, self.contact.places, self.contact.heights
        self.body = surface.body(strike.relaxation, self.scheme, self.scale)

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
        gap = self.body.displacement(state.memory.body) - self.contact.overlap(state.depth)
        touching = solution.signed_pressure > 0.0
        return np.where(touching, 0.0, gap - np.median(gap[touching]))

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

    def lost(self, before: Any, after: Any, length: float) -> float:
        """Of the work in a step of a length, s, what the scheme leaves unaccounted for, J."""
        return self.body.lost(before.body, after.body, length)

    def between(self, before: State, step: Step) -> float:
        """Work of the striker in a step that does not reach the body, J: of the penalty, and at a gap that opens."""
        operator, after = self.surface.operator, step.state
        sunk = self.body.displacement(after.memory.body) - self.body.displacement(before.memory.body)
        reached = self.scale ** (operator.dimension - 2) * float(operator.weights @ (step.solution.pressure * sunk))
        return step.force * (after.depth - before.depth) - reached
