"""An implicit step: one effective matrix, factorised once for every length of step.

With the increment d = u' - u of a :class:`~fe_contact.dynamics.schemes.base.Scheme` (beta > 0) the balance

    M a_(1 - alpha_m) + C v_(1 - alpha_f) + f_(1 - alpha_f) = weight + push p_(1 - alpha_f)

is A d = known + (1 - alpha_f) push p' ,
A = (1 - alpha_m)/(beta dt^2) M + (1 - alpha_f) [gamma/(beta dt) C + sum of modulus x stiffness] ,

where branches count a little later, see :mod:`fe_contact.dynamics.memory`.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from fe_contact.assembly.forms import Array, Matrix
from fe_contact.assembly.interior import factorized
from fe_contact.assembly.pressed_surface import PressedSurface
from fe_contact.dynamics import memory
from fe_contact.dynamics.body import BodyWithMass
from fe_contact.dynamics.pressed import Enforced, Found, surface_of
from fe_contact.dynamics.schemes.base import Scheme
from fe_contact.dynamics.state import BodyState, internal


class ImplicitStepper:
    """Takes steps of one length, s, of one body by one scheme."""

    def __init__(self, body: BodyWithMass, scheme: Scheme, enforced: Enforced, step: float) -> None:
        self.body, self.scheme, self.enforced, self.step = body, scheme, enforced, step
        self.laws = [memory.part_law(part, step) for part in body.parts]
        self.solve = factorized(self._effective())

    def begun(self, state: BodyState) -> BodyState:
        """The first state: the pressure of a first step belongs to its end."""
        return state

    @cached_property
    def moved(self) -> Array:
        """Increments (N, m) of unit surface forces."""
        return np.asarray((1 - self.scheme.alpha_f) * self.solve(self.body.pressing.push.toarray()))

    @cached_property
    def surface(self) -> PressedSurface:
        """What contact knows of the body in a step."""
        pressing = self.body.pressing
        return surface_of(pressing.push.T @ self.moved, pressing)

    def advance(self, state: BodyState) -> tuple[BodyState, Found]:
        """The state a step later; raises ContactNotSettled."""
        pressing = self.body.pressing
        change = self._free(state)
        overlap = pressing.overlap(state.displacement + change)
        found = self.enforced.found(self.surface, overlap, state.signed_pressure > 0.0, state.time)
        change += self.moved @ pressing.forces(found.pressure)
        return self._moved(state, change, found), found

    def flown(self, state: BodyState) -> BodyState:
        """The state a step later if nothing presses in it, its signed pressure that of the overlap."""
        change = self._free(state)
        overlap = self.body.pressing.overlap(state.displacement + change)
        return self._moved(state, change, Found(self.enforced.penalty * overlap, 0))

    def _free(self, state: BodyState) -> Array:
        """The increment (N,) without new pressure."""
        return self.solve(self._known(state) + self.scheme.alpha_f * self.body.pressing.load(state.pressure))

    def _effective(self) -> Matrix:
        body, (alpha_m, alpha_f, beta, gamma), dt = self.body, self.scheme, self.step
        matrix = (1 - alpha_m) / (beta * dt**2) * body.inertia
        for part, law in zip(body.parts, self.laws, strict=True):
            matrix = matrix + ((1 - alpha_f) * law.now + float(law.late @ law.gain)) * part.stiffness
        if body.damping is not None:
            matrix = matrix + (1 - alpha_f) * gamma / (beta * dt) * body.damping
        return matrix

    def _known(self, state: BodyState) -> Array:
        """Forces that the past fixes, (N,)."""
        body, (alpha_m, alpha_f, _, _) = self.body, self.scheme
        v, a = self._newmark(state, np.zeros(body.size))  # at the end of a step in which nothing moves
        forces = body.weight - body.inertia @ ((1 - alpha_m) * a + alpha_m * state.acceleration)
        forces -= alpha_f * state.internal
        for part, law, branches in zip(body.parts, self.laws, state.branches, strict=True):
            held = memory.past(part, law, state.displacement, branches)
            faded = law.late @ ((law.decay - 1.0)[:, None] * branches)
            forces -= part.stiffness @ ((1 - alpha_f) * held + faded)
        if body.damping is not None:
            forces -= body.damping @ ((1 - alpha_f) * v + alpha_f * state.velocity)
        return np.asarray(forces)

    def _newmark(self, state: BodyState, change: Array) -> tuple[Array, Array]:
        """Velocity and acceleration at the end of a step with an increment of displacement."""
        (_, _, beta, gamma), dt = self.scheme, self.step
        v, a = state.velocity, state.acceleration
        late = (change - dt * v - dt**2 * (0.5 - beta) * a) / (beta * dt**2)
        return v + dt * ((1 - gamma) * a + gamma * late), late

    def _moved(self, state: BodyState, change: Array, found: Found) -> BodyState:
        velocity, acceleration = self._newmark(state, change)
        displacement = state.displacement + change
        branches = tuple(
            law.decay[:, None] * own + law.gain[:, None] * change
            for law, own in zip(self.laws, state.branches, strict=True)
        )
        return BodyState(
            time=state.time + self.step,
            displacement=displacement,
            velocity=velocity,
            acceleration=acceleration,
            branches=branches,
            internal=internal(self.body, displacement, branches),
            signed_pressure=found.signed_pressure,
        )
