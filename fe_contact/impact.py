"""One impact of a rigid striker, from physics and settings to a march; knows nothing of plans and bars.

Each step solves one contact problem on the mesh scaled to the contact radius expected in that step; where
the edge turns out to lie outside the mesh's finest elements, the mesh is scaled again and the step redone.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import ModuleType

import numpy as np

from fe_contact.account import record
from fe_contact.bodies.memory import StepLaw, SurfaceMemory, interpolate, step_law
from fe_contact.bodies.scaled_surface import ScaledSurface
from fe_contact.contact import ContactSolution
from fe_contact.errors import ContactLost, ContactNotSettled, MemoryTooSmall, TooManySteps
from fe_contact.forms import Array
from fe_contact.march import March, Strike, Work
from fe_contact.numerics import ENFORCEMENTS, SCHEMES, Numerics
from fe_contact.separation import time_left
from fe_contact.steps import State, Step
from fe_contact.time_grid import step_length
from lumped.members import get

EDGE_WINDOW = 0.02  # the contact edge may lie this far from the node where the mesh is finest
RESCALINGS = 60
PATIENCE = 8  # rescalings after which the window widens by half each time: the edge may jitter in the last tail
MEMORY_POINTS = 1200
MEMORY_REACH = 1.5  # memory extends to this multiple of the expected contact radius
APPROACH_TO_END = 0.4  # share of the time left that a step may take near separation
END_REACHED = 1e-3  # time left over contact time at which separation is read off the trend
BEYOND = 1e3  # height, in contact radii, given to radii past the striker's rim
PREDICTIONS = 3  # of the separation: how far they lie apart tells how well its time can be read
NOISE = 1e-4  # share of the peak force below which a contact problem may drown in the mesh's error
AT_REST = 1e-4  # share of the velocity at touch below which a fluid has stopped the striker
REST_ROWS = 12
FAINT = 1e-3  # share of the peak force below which contact may end
VANISHING = 1e-4  # contact that shrinks by this much within a step is lost
STEPS_ALLOWED = 20  # multiple of the settings' steps after which the march gives up


def march(strike: Strike, surface: ScaledSurface, numerics: Numerics) -> March:
    """Integrate from first touch to separation, or to ``strike.end_time``.

    Raises the named failures of :mod:`fe_contact.errors` where a step does not converge.
    """
    return _Marcher(strike, surface, numerics).run()


class _Marcher:
    """The loop: what stays the same through an impact is held here, what changes is passed and returned."""

    def __init__(self, strike: Strike, surface: ScaledSurface, numerics: Numerics) -> None:
        self.strike, self.surface, self.numerics = strike, surface, numerics
        self.scheme: ModuleType = get(SCHEMES, numerics.scheme)
        self.enforcement: ModuleType = get(ENFORCEMENTS, numerics.enforcement)
        self.shortest = END_REACHED * numerics.contact_time

    def run(self) -> March:
        strike = self.strike
        radii = np.linspace(0.0, MEMORY_REACH * self.numerics.contact_radius, MEMORY_POINTS)
        memory = SurfaceMemory.at_rest(radii, strike.relaxation)
        states = [State(0.0, 0.0, strike.velocity, 0.0, memory)]
        steps: list[Step] = []
        separated = False
        free_fluid = strike.relaxation.equilibrium == 0 and strike.gravity == 0
        resting = AT_REST * strike.velocity if free_fluid else 0.0
        predicted: list[float] = []
        while states[-1].time < strike.end_time * (1 - 1e-12):
            if len(steps) > STEPS_ALLOWED * self.numerics.steps:
                raise TooManySteps(len(steps), states[-1].time)
            left = self._time_left(steps)
            predicted.append(states[-1].time + (left or 0.0))
            step = None if left is not None and left <= self.shortest else self._advance(states[-1], steps, left)
            if step is None:
                separated = states[-1].velocity < -resting
                left = min(left or 0.0, self.shortest)
                states += self._flight(states[-1], left) if separated else self._rest(states[-1], resting)
                break
            steps.append(step)
            states.append(step.state)
        spread = np.ptp(predicted[-PREDICTIONS:]) if separated else 0.0
        return record(strike, self.surface, self.numerics, self.scheme, states, steps, separated, float(spread))

    def _time_left(self, steps: list[Step]) -> float | None:
        """Time to separation while the striker leaves, else None."""
        if len(steps) < 4 or steps[-1].state.velocity >= 0:
            return None
        recent = steps[-3:]
        times = [s.state.time - (1 - self.scheme.SAMPLE) * s.length for s in recent]
        left = time_left(times, [s.axis_response for s in recent], recent[-1].state.time)
        # a kink in the trend is not the end: contact ends faintly
        return None if left is None or (left <= self.shortest and not self._faint(steps, FAINT)) else left

    def _advance(self, state: State, steps: list[Step], left: float | None) -> Step | None:
        """The next step: on the grid, shorter towards separation, and again where contact was lost in it.

        None if contact does not last even for the shortest step.
        """
        length = self._grid_length(len(steps))
        if left is not None:
            length = min(length, APPROACH_TO_END * left)
        length = min(length, self.strike.end_time - state.time)
        while True:
            try:
                return self._step(state, steps, length)
            except (ContactLost, ContactNotSettled, MemoryTooSmall) as failure:
                if not steps or not (isinstance(failure, ContactLost) or self._faint(steps, NOISE)):
                    raise
                length /= 2
                if length < self.shortest:
                    return None

    @staticmethod
    def _faint(steps: list[Step], share: float) -> bool:
        """Whether the force has fallen below a share of its peak."""
        return steps[-1].force <= share * max(step.force for step in steps)

    def _grid_length(self, done: int) -> float:
        """Length of the next regular step."""
        numerics = self.numerics
        return numerics.contact_time * step_length(done, numerics.steps, numerics.peak_share)

    def _step(self, state: State, steps: list[Step], length: float) -> Step:
        strike, scheme, end = self.strike, self.scheme, self.strike.end_time
        law = step_law(strike.relaxation, scheme, length)
        carried = state.memory.carried(law)
        lever = scheme.LEVER * length**2
        free_depth = state.depth + length * state.velocity + lever * strike.gravity
        scale, solution, work = self._settle(state, steps, law, carried[0], free_depth, lever / strike.mass, length)
        force = scale * float(self.surface.operator.weights @ solution.pressure)
        depth = free_depth - lever * force / strike.mass
        radius = scale * solution.edge(self.surface.operator.points)
        stress = self._stress(state.memory.radii, scale, solution.pressure)
        touching = state.memory.radii < radius
        # in contact the surface is the striker's: what penalty is left in the trace must not be remembered
        held = law.now * (depth - strike.height(state.memory.radii[touching])) + carried[0, touching]
        stress[0, touching] = held
        memory = state.memory.advanced(law, stress)
        moved = State(
            time=end if length >= end - state.time else state.time + length,
            depth=depth,
            velocity=state.velocity + length * (strike.gravity - force / strike.mass),
            impulse=state.impulse + length * force,
            memory=memory,
        )
        return Step(
            length=length,
            state=moved,
            force=force,
            radius=radius,
            axis_response=float(stress[0, 0]),
            solution=solution,
            scale=scale,
            heat=state.memory.dissipated(memory, strike.relaxation, length),
            work=work,
        )

    def _settle(
        self,
        state: State,
        steps: list[Step],
        law: StepLaw,
        carried: Array,
        free_depth: float,
        yielding: float,
        length: float,
    ) -> tuple[float, ContactSolution, Work]:
        """Scale the mesh until the contact edge lies in its finest elements."""
        operator = self.surface.operator
        scale = self._expected_radius(state, steps, free_depth, length)
        work = Work(steps=1)
        for attempt in range(RESCALINGS):
            radii = scale * operator.points
            if radii[-1] > state.memory.radii[-1]:
                raise MemoryTooSmall(radii[-1])
            height = np.minimum(self.strike.height(radii), BEYOND * radii[-1])  # a profile may end
            overlap = law.now * (free_depth - height)
            overlap += interpolate(carried, state.memory.radii[1], radii)
            problem = self.surface.problem(overlap, self.numerics.penalty, law.now * yielding * scale)
            solution = self.enforcement.enforce(problem, operator.points < 1.0)
            work = replace(
                work,
                contact_problems=work.contact_problems + self.enforcement.SOLVES,
                iterations=work.iterations + solution.iterations,
            )
            if not solution.converged:
                raise ContactNotSettled(state.time)
            edge = solution.edge(operator.points)
            if abs(edge - 1) <= EDGE_WINDOW * 1.5 ** max(attempt - PATIENCE, 0) and np.isfinite(edge):
                return scale, solution, work
            scale *= min(max(edge, 0.3), operator.points[-1])
            if scale < VANISHING * (steps[-1].radius if steps else VANISHING * self.numerics.contact_radius):
                raise ContactLost(state.time)
        raise ContactNotSettled(state.time)

    def _expected_radius(self, state: State, steps: list[Step], depth: float, length: float) -> float:
        """Contact radius in the coming step: its square is nearly linear in time."""
        if not steps:
            return _overlap_radius(self.strike.height, depth, state.memory.radii)
        last = steps[-1]
        before = steps[-2].radius if len(steps) > 1 else 0.0
        apart = 0.5 * (last.length + (steps[-2].length if len(steps) > 1 else 0.0))
        slope = (last.radius**2 - before**2) / apart
        square = last.radius**2 + slope * 0.5 * (last.length + length)
        return float(np.sqrt(max(square, 0.05 * last.radius**2)))

    def _stress(self, radii: Array, scale: float, pressure: Array) -> Array:
        """Displacement times modulus, and pressure, on the memory's radii; shape (2, r)."""
        displacement = self.surface.sample(self.surface.response(pressure), radii / scale)
        spread = np.interp(radii / scale, self.surface.operator.points, pressure / scale, right=0.0)
        return np.stack([displacement, spread])

    def _flight(self, state: State, left: float) -> list[State]:
        """The little time to separation, over which the force is below any rounding that matters."""
        if left == 0.0:
            return []
        pull = self.strike.gravity * left
        depth = state.depth + left * (state.velocity + 0.5 * pull)
        return [replace(state, time=state.time + left, depth=depth, velocity=state.velocity + pull)]

    def _rest(self, state: State, resting: float) -> list[State]:
        """A striker that a fluid has stopped, up to the end time; raises where it is no fluid or still moves."""
        strike = self.strike
        if resting == 0.0 or state.velocity > resting:
            raise ContactNotSettled(state.time)
        roots = np.linspace(np.sqrt(state.time), np.sqrt(strike.end_time), REST_ROWS)[1:]
        return [replace(state, time=float(root) ** 2) for root in roots]


def _overlap_radius(height: Callable[[Array], Array], depth: float, radii: Array) -> float:
    """Radius at which the undeformed profile lies ``depth`` above its tip, by bisection."""
    low, high = 0.0, float(radii[-1])
    for _ in range(200):
        middle = 0.5 * (low + high)
        if height(np.array([middle]))[0] < depth:
            low = middle
        else:
            high = middle
        if high - low < 1e-3 * high:
            break
    return high
