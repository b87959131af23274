"""An explicit step (beta = 0): displacements first, then the pressure, then accelerations.

Where the surface has mass, its overlap at the step's end is known: a pressure law needs no more, while a constraint
keeps the *next* overlap closed, which is the first that the pressure can move (Carpenter, Taylor and Katona 1991,
doi:10.1002/nme.1620320107). Where it has none it obeys statics at the step's end, and so does the contact (Doyen, Ern
and Piperno 2011, doi:10.1137/100791440, section 6.2).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fe_contact.assembly.forms import Array
from fe_contact.assembly.interior import factorized
from fe_contact.assembly.pressed_surface import PressedSurface
from fe_contact.dynamics import memory
from fe_contact.dynamics.body import BodyWithMass
from fe_contact.dynamics.pressed import Enforced, Found, surface_of
from fe_contact.dynamics.schemes.base import Scheme
from fe_contact.dynamics.state import BodyState, internal
from lumped.errors import BadInput, Fault


class ExplicitStepper:
    """Takes steps of one length, s, of one body. Raises BadInput for a material with a parallel viscosity."""

    def __init__(self, body: BodyWithMass, scheme: Scheme, enforced: Enforced, step: float) -> None:
        if any(part.relaxation.viscosity > 0.0 for part in body.parts):
            reason = "an explicit scheme has no answer to a parallel viscosity; accepted: an implicit one"
            raise BadInput(Fault("numerics", "scheme", reason))
        self.body, self.scheme, self.enforced, self.step = body, scheme, enforced, step
        self.laws = [memory.part_law(part, step) for part in body.parts]
        inertia = body.inertia if body.damping is None else body.inertia + step / 2 * body.damping
        self._surfaces: dict[float, PressedSurface] = {}  # by lever: one, and at first another
        self.accelerate = factorized(inertia[body.massive][:, body.massive])

    def begun(self, state: BodyState) -> BodyState:
        """The first state with the pressure that a constraint on a surface with mass needs at once."""
        if self.body.massless.size or self.enforced.is_law:
            return state
        ahead = state.displacement + self.step * (state.velocity + self.step / 2 * state.acceleration)
        found = self._constrained(state, ahead, self.step**2 / 2)
        pushed = state.acceleration + self._accelerated(self.body.pressing.load(found.pressure))
        return state._replace(acceleration=pushed, signed_pressure=found.signed_pressure)

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
        branches = tuple(
            law.decay[:, None] * own + law.gain[:, None] * change
            for law, own in zip(self.laws, state.branches, strict=True)
        )
        forces = internal(body, displacement, branches)
        driving = body.weight - forces if body.damping is None else body.weight - forces - body.damping @ middle
        if found is None:
            found = self._pressed(state, displacement, middle, driving)
        acceleration = self._accelerated(driving + body.pressing.load(found.pressure))
        velocity = middle + dt / 2 * acceleration
        velocity[body.massless] = change[body.massless] / dt
        pressure = found.signed_pressure
        return BodyState(state.time + dt, displacement, velocity, acceleration, branches, forces, pressure), found

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
            held = memory.past(part, law, state.displacement, branches) + law.now * change
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
