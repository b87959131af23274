"""What goes into an impact, what a march carries from step to step, and what comes out of it.

What goes in and comes out are frozen records; what is carried are named tuples, of which there are many and which are
quick to make. The rigid striker in a time step: where it would be free of force, and where the force leaves it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple, Protocol

from fe_contact.assembly.forms import Array
from fe_contact.bodies.memory import OneNetwork, SurfaceMemory
from fe_contact.bodies.offer import Memory
from fe_contact.contact.problem import ContactSolution
from fe_contact.schemes.base import MemoryScheme
from fe_contact.settings import Numerics
from lumped.materials import Relaxation
from lumped.scene.scene import Scene


@dataclass(frozen=True)
class Strike:
    """Physics of an impact: profile height(r), m; mass, kg; velocity, m/s; gravity along the motion, m/s2;
    contact modulus E*(t); time at which to stop, s after touch; where it is not depth - height, overlap(arc, depth), m;
    the length over which forces and modulus are totals in plane strain, m, else 1; and the ``power`` of the depth that
    an elastic force begins with.

    A later one of several begins with a touch at a time, s since the first one, and a depth, m, on a body with a
    ``memory``, None: at rest.
    """

    height: Callable[[Array], Array]
    mass: float
    velocity: float
    gravity: float
    relaxation: Relaxation
    end_time: float
    overlap: Callable[[Array, float], Array] | None = None
    total: float = 1.0
    power: float = 1.5
    touched_at: float = 0.0
    depth: float = 0.0
    memory: Memory = None

    def again(self, flown: float, depth: float, velocity: float, memory: Memory = None) -> Strike:
        """The strike that begins with a touch, some time ``flown`` after this one, s, at a depth, m, and m/s."""
        return replace(
            self,
            velocity=velocity,
            depth=depth,
            memory=memory,
            touched_at=self.touched_at + flown,
            end_time=self.end_time - flown,
        )

    @classmethod
    def of(cls, scene: Scene) -> Strike:
        """The first touch of a scene; forces in plane strain are totals, so the modulus counts with the length."""
        target, profile = scene.target, scene.profile
        place, lead = target.length_of_place, target.lead
        bent = None if place == 1.0 else lambda arc, depth: target.overlap(profile, arc / place, depth)
        return cls(
            overlap=bent,
            height=lambda r: -target.overlap(profile, r / place, 0.0) / lead,
            mass=scene.reduced_mass,
            velocity=scene.velocity,
            gravity=scene.gravity,
            relaxation=scene.contact_modulus.scaled(scene.geometry.shape.total),
            end_time=scene.end_time,
            total=scene.geometry.shape.total,
            power=scene.profile.exponent_of_force,
        )


@dataclass(frozen=True)
class Snapshot:
    """Surface in one step: time, s; force, N; contact radius, m; radii and pressure at the quadrature points, m, Pa.

    In plane strain the pressure too is a total over the length, Pa m.
    """

    time: float
    force: float
    contact_radius: float
    radii: Array
    pressure: Array


class Work(NamedTuple):
    """Counted work: time steps, contact problems, Newton iterations."""

    steps: int = 0
    contact_problems: int = 0
    iterations: int = 0

    def more(self, problems: int, iterations: int) -> Work:
        """With so many contact problems and Newton iterations more."""
        return Work(self.steps, self.contact_problems + problems, self.iterations + iterations)


@dataclass(frozen=True)
class March:
    """History of one impact with one set of settings.

    ``time``, ``depth``, ``impulse`` (n,) at the ends of the steps, the first row at touch, the last at
    separation or ``end_time``; ``first_force``, N, right at touch; ``radius_time``, ``radius`` (n,) of the contact;
    ``photograph`` makes a snapshot a step; ``energy`` J, each term computed on its own; ``end_spread`` s, how far
    the last predictions of the separation lie apart; ``memory`` of the body after the last step, at ``memory_time``, s;
    ``dent``: the depth, m, that stays for ever in a body that yields.
    """

    time: Array
    depth: Array
    impulse: Array
    first_force: float
    radius_time: Array
    radius: Array
    separated: bool
    photograph: Callable[[], tuple[Snapshot, ...]]
    energy: dict[str, float]
    end_spread: float
    work: Work
    memory: Memory = None
    memory_time: float = 0.0
    dent: float | None = None

    @cached_property
    def snapshots(self) -> tuple[Snapshot, ...]:
        """The surface in every step, where it is known; read when first asked for: few impacts ever show it."""
        return self.photograph()


class State(NamedTuple):
    """Striker and body at an instant: s, m, m/s, N s since touch; ``memory`` is the body's own."""

    time: float
    depth: float
    velocity: float
    impulse: float
    memory: Memory


class Step(NamedTuple):
    """A step taken, SI units: its length, the state after it, force and contact radius in it, and when that was.

    ``axis_response`` is the axis' displacement times modulus, ``scale`` the contact radius the mesh was scaled
    to, ``solution`` in units of the unit mesh.
    """

    length: float
    state: State
    force: float
    radius: float
    radius_time: float
    axis_response: float
    solution: ContactSolution
    scale: float
    work: Work


class Stepping(Protocol):
    """Takes the steps of one body.

    ``shortest``: time left, in expected contact times, at which separation is read off the trend; ``first_force``
    right at touch, N: not zero where a dashpot meets an area at once.
    """

    strike: Strike
    numerics: Numerics
    scheme: MemoryScheme
    shortest: float
    first_force: float

    def touch(self) -> State:
        """The striker at the surface, at rest or with what it remembers."""

    def remembered(self, memory: Memory) -> SurfaceMemory:
        """What the surface remembers, of a body that recovers."""

    def standing(self) -> int:
        """Which place of that memory lies at the first touch."""

    def clearance(self, surface: SurfaceMemory, depth: float) -> Array:
        """Gap of the surfaces at all places of the body, m, where the striker is at a depth, m."""

    def step(self, state: State, steps: Sequence[Step], length: float) -> Step:
        """The step of a length, s, from a state reached by ``steps``; raises ContactLost and its like."""

    def snapshots(self, steps: Sequence[Step]) -> tuple[Snapshot, ...]:
        """The pressure of every step, where it is known."""

    def stored(self, memory: Memory) -> float:
        """Elastic energy, J."""

    def heat_and_loss(self, before: Memory, after: Memory, length: float) -> tuple[float, float]:
        """Heat of a step of a length, s; of the work on the body in it what a scheme leaves unaccounted for; J."""

    def between(self, before: State, step: Step) -> float:
        """Work of the striker in a step that does not reach the body, J: across a gap that opens or closes."""


class OfSurface(OneNetwork):
    """What, of the contract of :class:`Stepping`, all do on a body whose memory is that of its surface alone."""

    strike: Strike

    def at_rest(self) -> SurfaceMemory:
        """The memory of a body that nothing has touched yet."""
        raise NotImplementedError

    def touch(self) -> State:
        """The striker at the surface, at rest or with what it remembers."""
        strike = self.strike
        return State(0.0, strike.depth, strike.velocity, 0.0, strike.memory or self.at_rest())

    def remembered(self, memory: SurfaceMemory) -> SurfaceMemory:
        """All that is remembered."""
        return memory


def radius_time(scheme: MemoryScheme, velocity: float, time: float, length: float) -> float:
    """When the contact has the radius of a step, s: growing, at its end; receding, where the force is sampled."""
    return time + length * (1.0 if velocity > 0.0 else scheme.sample)


def coming_square(steps: Sequence[Step], at: float) -> float:
    """Square of the contact radius at a time, s, after one step or more; m2.

    It is smooth in time, and zero at touch: the polynomial through the last two or three, Newton's form.
    """
    known = [(0.0, 0.0), *((step.radius_time, step.radius**2) for step in steps[-3:])][-3:]
    (before, previous), (last, value) = known[-2:]
    slope = (value - previous) / (last - before)
    if len(known) < 3:
        return value + slope * (at - last)
    first, start = known[0]
    bend = (slope - (previous - start) / (before - first)) / (last - first)
    return value + (at - last) * (slope + bend * (at - before))


class Inertia(NamedTuple):
    """All that contact sees of the striker in a step of a ``length``, s, from a state: depth = free depth - give force.

    ``lever``, s2: displacement in the step per acceleration, by the scheme.
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
