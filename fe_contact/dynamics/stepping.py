"""A step in time of a body with mass, implicit or explicit, and the contact problem in it.

What would overlap without new pressure, and how the body yields to it, is all that contact knows.

Implicit: one effective matrix, factorised once for every length of step. With the increment d = u' - u of a
:class:`~fe_contact.dynamics.schemes.base.Scheme` (beta > 0) the balance

    M a_(1 - alpha_m) + C v_(1 - alpha_f) + f_(1 - alpha_f) = weight + push p_(1 - alpha_f)

is A d = known + (1 - alpha_f) push p' ,
A = (1 - alpha_m)/(beta dt^2) M + (1 - alpha_f) [gamma/(beta dt) C + sum of modulus x stiffness] ,

where branches count a little later, see :mod:`fe_contact.dynamics.body`.

Explicit (beta = 0): displacements first, then the pressure, then accelerations. Where the surface has mass, its overlap
at the step's end is known: a pressure law needs no more, while a constraint keeps the *next* overlap closed, which is
the first that the pressure can move (Carpenter, Taylor and Katona 1991, doi:10.1002/nme.1620320107). Where it has none
it obeys statics at the step's end, and so does the contact (Doyen, Ern and Piperno 2011, doi:10.1137/100791440,
section 6.2).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array, Indices, Matrix
from fe_contact.assembly.interior import factorized
from fe_contact.contact.enforcement.base import Enforcement
from fe_contact.contact.problem import ContactProblem, PressedSurface, Touching
from fe_contact.dynamics.body import BodyState, BodyWithMass, Pressing, internal, motions_of, state_of
from fe_contact.dynamics.flow import flow_of_step
from fe_contact.dynamics.schemes.base import Scheme
from fe_contact.errors import ContactNotSettled
from lumped.errors import BadInput, Fault

NO_FLOW = "explicit: nothing yields by it; accepted: an implicit one"  # of a scheme


@dataclass(frozen=True, eq=False)
class Enforced:
    """A member of :mod:`fe_contact.contact.enforcement`, or like one, and its penalty, Pa/m."""

    member: Enforcement
    penalty: float

    @property
    def is_law(self) -> bool:
        """Whether pressure follows from the overlap alone, wherever that comes from."""
        return self.member.law is not None

    def known(self, overlap: Array) -> Found:
        """Pressure of an overlap (q,) that no pressure changes any more, of a member that is a law."""
        assert self.member.law is not None
        return Found(self.member.law(overlap, self.penalty), 0)

    def found(self, surface: PressedSurface, overlap: Array, touching: Touching, time: float) -> Found:
        """Pressure that leaves of a free overlap (q,) what the member allows; raises ContactNotSettled."""
        if not (touching.any() or (overlap > 0.0).any()):
            return Found(self.penalty * overlap, 0)
        problem = ContactProblem(surface, overlap, self.penalty)
        solution = self.member.enforce(problem, touching)
        if not solution.converged:
            raise ContactNotSettled(time, self.member.settling)
        return Found(solution.signed_pressure, solution.iterations)


class Found(NamedTuple):
    """Signed pressure (q,), negative where open, Newton iterations and contact ``problems`` solved for it."""

    signed_pressure: Array
    iterations: int
    problems: int = 1

    @property
    def pressure(self) -> Array:
        """Contact pressure (q,), >= 0."""
        return np.maximum(self.signed_pressure, 0.0)


def surface_of(compliance: Array, pressing: Pressing, nodes: Indices | slice = slice(None)) -> PressedSurface:
    """What contact knows of a body whose surface ``nodes`` (m,) move by ``compliance`` (m, m) per force."""
    symmetric = (compliance + compliance.T) / 2
    stiffness = np.linalg.inv(symmetric)
    trace = pressing.trace[:, nodes]
    square = (stiffness + stiffness.T) / 2
    return PressedSurface(square, trace, pressing.weights, recurring=False, carriers=pressing.carriers)


class ImplicitStepper:
    """Takes steps of one length, s, of one body by one scheme."""

    def __init__(self, body: BodyWithMass, scheme: Scheme, enforced: Enforced, step: float) -> None:
        self.body, self.scheme, self.enforced, self.step = body, scheme, enforced, step
        self.laws = [part.law(step) for part in body.parts]
        self._onwards, self._of_change = _newmark(scheme, step)
        self.effective = Effective(body.pressing, enforced, self._matrix(), 1 - scheme.alpha_f)

    def begun(self, state: BodyState) -> BodyState:
        """The first state: the pressure of a first step belongs to its end."""
        return state

    @cached_property
    def _matrices(self) -> Matrix:
        """Unit stiffness of every part, inertia and damping, one above the other."""
        body = self.body
        damping = sparse.csr_matrix((body.size, body.size)) if body.damping is None else body.damping
        return sparse.vstack([*(part.stiffness for part in body.parts), body.inertia, damping]).tocsr()

    def advance(self, state: BodyState) -> tuple[BodyState, Found]:
        """The state a step later; raises ContactNotSettled, FlowNotSettled."""
        forces = self._forces(state)
        if self.body.yields is None or state.flowed is None:
            change, found = self.effective.increment(state, forces)
            return self._moved(state, change, found), found
        late, tried = 1 - self.scheme.alpha_f, list[Found]()

        def change_with(softening: Matrix | None) -> Callable[[Array], Array]:
            effective = self.effective if softening is None else self.effective.less(softening)

            def change_under(held: Array) -> Array:
                change, found = effective.increment(state, forces + late * held)
                tried.append(found)
                return change

            return change_under

        flowed, change = flow_of_step(change_with, state.displacement, self.body.yields, state.flowed, state.time)
        last = Found(tried[-1].signed_pressure, sum(found.iterations for found in tried), len(tried))
        return self._moved(state, change, last)._replace(flowed=flowed), last

    def flown(self, state: BodyState) -> BodyState:
        """The state a step later if nothing presses and flows in it, its signed pressure that of the overlap."""
        held = 0.0 if state.flowed is None else (1 - self.scheme.alpha_f) * state.flowed.forces
        change = self.effective.solve(self._forces(state) + held)
        overlap = self.body.pressing.overlap(state.displacement + change)
        return self._moved(state, change, Found(self.enforced.penalty * overlap, 0))

    def _forces(self, state: BodyState) -> Array:
        """Forces (N,) without new pressure, and without what plastic strain holds at the end."""
        early = self.body.pressing.load(state.pressure)
        if state.flowed is not None:
            early = early + state.flowed.forces
        return self._known(state) + self.scheme.alpha_f * early

    def _matrix(self) -> Matrix:
        body, (alpha_m, alpha_f, beta, gamma, _), dt = self.body, self.scheme, self.step
        matrix = (1 - alpha_m) / (beta * dt**2) * body.inertia
        for part, law in zip(body.parts, self.laws, strict=True):
            matrix = matrix + ((1 - alpha_f) * law.now + float(law.late @ law.gain)) * part.stiffness
        if body.damping is not None:
            matrix = matrix + (1 - alpha_f) * gamma / (beta * dt) * body.damping
        return matrix

    def _known(self, state: BodyState) -> Array:
        """Forces that the past fixes, (N,): those of a step in which nothing moves."""
        body, (alpha_m, alpha_f, *_) = self.body, self.scheme
        forces = body.weight - ((1 - alpha_m) * self._onwards[2] @ state.pushed + alpha_m * state.pushed[2])
        for part, law, pulls in zip(body.parts, self.laws, state.pulls, strict=True):
            held = (1 - alpha_f) * part.past(law, pulls[0], pulls[1:])
            forces -= held + alpha_f * part.stressed(pulls[0], pulls[1:]) + (law.late * (law.decay - 1.0)) @ pulls[1:]
        if body.damping is not None:
            forces -= (1 - alpha_f) * self._onwards[1] @ state.damped + alpha_f * state.damped[1]
        return np.asarray(forces)

    def _moved(self, state: BodyState, change: Array, found: Found) -> BodyState:
        """The state after an increment (N,)."""
        *pulled, pushed, damped = (self._matrices @ change).reshape(-1, change.size)
        moves = np.array([change, pushed, damped])
        return BodyState(
            time=state.time + self.step,
            motions=self._onwards @ state.motions + self._of_change[:, None] * moves[:, None],
            branches=tuple(law.moved(own, change) for law, own in zip(self.laws, state.branches, strict=True)),
            pulls=tuple(law.pulled(own, pull) for law, own, pull in zip(self.laws, state.pulls, pulled, strict=True)),
            signed_pressure=found.signed_pressure,
            flowed=state.flowed,
        )


@dataclass(frozen=True, eq=False)
class Effective:
    """Increments of a body in a step by its effective ``matrix`` (N, N), factorised once; ``late``: what counts of the
    pressure at the end.
    """

    pressing: Pressing
    enforced: Enforced
    matrix: Matrix
    late: float

    def less(self, softening: Matrix) -> Effective:
        """The same of a body that gives way by so much more, (N, N)."""
        return replace(self, matrix=self.matrix - self.late * softening)

    @cached_property
    def solve(self) -> Callable[[Array], Array]:
        """Back-substitution, (N,)."""
        return factorized(self.matrix)

    @cached_property
    def moved(self) -> tuple[MovedBody, ...]:
        """Increments by surface forces; one solution serves all bodies that do not feel each other."""
        push = self.pressing.push
        bodies = _apart(self.matrix, push.tocsr())
        counts = [nodes.stop - nodes.start for _, nodes in bodies]
        forces = np.zeros((self.matrix.shape[0], max(counts)))
        for (own, nodes), count in zip(bodies, counts, strict=True):
            forces[own, :count] = push[own, nodes].toarray()
        found = self.late * self.solve(forces)
        return tuple(
            MovedBody(own, nodes, found[own, :count]) for (own, nodes), count in zip(bodies, counts, strict=True)
        )

    @cached_property
    def surface(self) -> PressedSurface:
        """What contact knows of the body in a step."""
        compliance = np.zeros((self.pressing.push.shape[1],) * 2)
        for own, nodes, increments in self.moved:
            compliance[nodes, nodes] += self.pressing.push[own, nodes].T @ increments
        return surface_of(compliance, self.pressing)

    def increment(self, state: BodyState, forces: Array) -> tuple[Array, Found]:
        """The increment (N,) by forces (N,) and by new pressure, and that; raises ContactNotSettled."""
        change = self.solve(forces)
        overlap = self.pressing.overlap(state.displacement + change)
        found = self.enforced.found(self.surface, overlap, state.signed_pressure > 0.0, state.time)
        by_surface = self.pressing.forces(found.pressure)
        for moved in self.moved:
            change[moved.own] += moved.by(by_surface)
        return change, found


class MovedBody(NamedTuple):
    """Increments (n, m) of the degrees of freedom of one body, ``own``, by unit forces on the surface ``nodes``."""

    own: slice
    nodes: slice
    increments: Array

    def by(self, forces: Array) -> Array:
        """Increment (n,) by forces on all nodes; beyond the contact they are none."""
        pressed = forces[self.nodes]
        count = np.flatnonzero(pressed).max(initial=-1) + 1
        return np.asarray(self.increments[:, :count] @ pressed[:count])


def _apart(matrix: Matrix, push: Matrix) -> list[tuple[slice, slice]]:
    """Of every body that feels no other its degrees of freedom, and the surface nodes that push it."""
    farthest = np.maximum.accumulate(np.maximum.reduceat(matrix.indices, matrix.indptr[:-1]))
    ends = np.flatnonzero(farthest == np.arange(farthest.size)) + 1
    found = []
    for start, end in zip([0, *ends], ends, strict=False):
        nodes = np.unique(push[start:end].nonzero()[1])
        if nodes.size:
            found.append((slice(start, end), slice(nodes[0], nodes[-1] + 1)))
    return found


def _newmark(scheme: Scheme, dt: float) -> tuple[Array, Array]:
    """What displacement, velocity and acceleration at a step's end owe to those at its start, (3, 3), and to the
    increment of the displacement, (3,).
    """
    _, _, beta, gamma, _ = scheme
    late = np.array([0.0, -1.0 / (beta * dt), 1.0 - 0.5 / beta])
    faster = np.array([0.0, 1.0, dt * (1.0 - gamma)]) + gamma * dt * late
    return np.array([[1.0, 0.0, 0.0], faster, late]), np.array([1.0, gamma / (beta * dt), 1.0 / (beta * dt**2)])


class ExplicitStepper:
    """Takes steps of one length, s, of one body. Raises BadInput for what yields, or has a parallel viscosity."""

    def __init__(self, body: BodyWithMass, scheme: Scheme, enforced: Enforced, step: float) -> None:
        if any(part.relaxation.viscosity > 0.0 for part in body.parts):
            reason = "an explicit scheme has no answer to a parallel viscosity; accepted: an implicit one"
            raise BadInput(Fault("numerics", "scheme", reason))
        if body.yields is not None:
            raise BadInput(Fault("numerics", "scheme", NO_FLOW))
        self.body, self.scheme, self.enforced, self.step = body, scheme, enforced, step
        self.laws = [part.law(step) for part in body.parts]
        inertia = body.inertia if body.damping is None else body.inertia + step / 2 * body.damping
        self._surfaces: dict[float, PressedSurface] = {}  # by lever: one, and at first another
        self.accelerate = factorized(inertia[body.massive][:, body.massive])

    def begun(self, state: BodyState) -> BodyState:
        """The first state with the pressure that a constraint on a surface with mass needs at once."""
        if self.body.massless.size or self.enforced.is_law:
            return state
        ahead = state.displacement + self.step * (state.velocity + self.step / 2 * state.acceleration)
        found = self._constrained(state, ahead, self.step**2 / 2)
        motion = state.motions[0].copy()
        motion[2] += self._accelerated(self.body.pressing.load(found.pressure))
        return state_of(self.body, state.time, motion, state.branches, found.signed_pressure)

    def advance(self, state: BodyState) -> tuple[BodyState, Found]:
        """The state a step later; raises ContactNotSettled."""
        body, dt = self.body, self.step
        middle = state.velocity + dt / 2 * state.acceleration  # half a step on
        change = dt * middle
        found = None
        if body.massless.size:
            change[body.massless] = 0.0
            change, found = self._settled(state, change)
        displacement = state.displacement + change
        branches = tuple(law.moved(own, change) for law, own in zip(self.laws, state.branches, strict=True))
        pulled = (part.stiffness @ change for part in body.parts)
        pulls = tuple(law.pulled(own, pull) for law, own, pull in zip(self.laws, state.pulls, pulled, strict=True))
        forces = internal(body, pulls)
        driving = body.weight - forces if body.damping is None else body.weight - forces - body.damping @ middle
        if found is None:
            found = self._pressed(state, displacement, middle, driving)
        acceleration = self._accelerated(driving + body.pressing.load(found.pressure))
        velocity = middle + dt / 2 * acceleration
        velocity[body.massless] = change[body.massless] / dt
        motions = motions_of(body, np.array([displacement, velocity, acceleration]))
        return BodyState(state.time + dt, motions, branches, pulls, found.signed_pressure), found

    def _accelerated(self, forces: Array) -> Array:
        """Acceleration (N,) under forces (N,) or of several, (N, m); zero without mass."""
        found = np.zeros_like(forces)
        found[self.body.massive] = self.accelerate(forces[self.body.massive])
        return found

    def _pressed(self, state: BodyState, displacement: Array, middle: Array, driving: Array) -> Found:
        """Pressure on a surface with mass."""
        if self.enforced.is_law:
            return self.enforced.known(self.body.pressing.overlap(displacement))
        ahead = displacement + self.step * (middle + self.step * self._accelerated(driving))
        return self._constrained(state, ahead, self.step**2)

    def _constrained(self, state: BodyState, ahead: Array, lever: float) -> Found:
        """Pressure that keeps the next displacement closed, which it moves by ``lever``, s^2, times acceleration."""
        overlap = self.body.pressing.overlap(ahead)
        return self.enforced.found(self._heavy(lever), overlap, state.signed_pressure > 0.0, state.time)

    def _heavy(self, lever: float) -> PressedSurface:
        if lever not in self._surfaces:
            pressing = self.body.pressing
            moved = self._accelerated(pressing.push.toarray())
            self._surfaces[lever] = surface_of(lever * (pressing.push.T @ moved), pressing)
        return self._surfaces[lever]

    def _settled(self, state: BodyState, change: Array) -> tuple[Array, Found]:
        """The increment with that of the surface without mass, and the pressure on it."""
        body, pressing = self.body, self.body.pressing
        forces = body.weight.copy()
        for part, law, branches in zip(body.parts, self.laws, state.branches, strict=True):
            held = part.past(law, state.displacement, branches) + law.now * change
            forces -= part.stiffness @ held
        light = self._light
        change[body.massless] = light.solve(forces[body.massless])
        overlap = pressing.overlap(state.displacement + change)
        found = self.enforced.found(light.surface, overlap, state.signed_pressure > 0.0, state.time)
        change[body.massless] += light.moved @ pressing.forces(found.pressure)[light.yielding]
        return change, found

    @cached_property
    def _light(self) -> _Light:
        pressing, light = self.body.pressing, self.body.massless
        held = [law.now * part.stiffness[light][:, light] for part, law in zip(self.body.parts, self.laws, strict=True)]
        solve = factorized(sum(held[1:], held[0]))
        push = pressing.push[light].toarray()
        yielding = np.flatnonzero(push.any(axis=0))  # a rigid striker does not yield at once
        moved = solve(push[:, yielding])
        surface = surface_of(push[:, yielding].T @ moved, pressing, yielding)
        return _Light(solve, moved, yielding, surface)


class _Light(NamedTuple):
    """Statics of the degrees of freedom without mass: ``solve`` their stiffness, ``moved`` per surface force of the
    ``yielding`` ones, which the ``surface`` consists of.
    """

    solve: Callable[[Array], Array]
    moved: Array
    yielding: npt.NDArray[np.intp]
    surface: PressedSurface
