"""Where the energy goes, step by step, every term computed on its own; what is left over is the residual.

Displacements are linear within a step: heat, radiation and work follow. What the scheme adds to that is its own
numerical loss, by its own numbers: with dx the change over a step, <x> the mean of its ends,

    dt (1 - alpha_m - gamma) <v>.M da + dt^2 (beta - gamma/2) da.M [<a> + (1/2 - alpha_m) da]      inertia,
    du . (f_(1 - alpha_f) - average of f)                                                  stress and damping,
    (work of the contact at 1 - alpha_f) - (change of what its springs hold)                          contact.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.dynamics.body import BodyState, BodyWithMass
from fe_contact.dynamics.schemes.base import Scheme


class Energies(NamedTuple):
    """J: ``work`` done so far by gravity, with the kinetic energy at the start; what stands in motion of ``rigid`` and
    ``deformable`` bodies, in ``strain`` and in the ``contact``'s springs; what was lost so far.
    """

    work: float
    rigid: float
    deformable: float
    strain: float
    contact: float
    viscous: float
    radiated: float
    numerical: float

    @property
    def total(self) -> float:
        """Kinetic, strain and contact energy."""
        return self.rigid + self.deformable + self.strain + self.contact

    @property
    def residual(self) -> float:
        """What no term accounts for."""
        return self.work - self.total - self.viscous - self.radiated - self.numerical


def opened(body: BodyWithMass, state: BodyState) -> Energies:
    """The ledger of a body about to move."""
    standing = _standing(body, state)
    return Energies(sum(standing), *standing, 0.0, 0.0, 0.0)


def entered(ledger: Energies, body: BodyWithMass, scheme: Scheme, before: BodyState, after: BodyState) -> Energies:
    """The ledger one step later."""
    step = after.time - before.time
    change = after.displacement - before.displacement
    standing = _standing(body, after)
    radiated = 0.0 if body.dashpots is None else float(change @ (body.dashpots @ change)) / step
    heats = [part.heat(step, change, own) for part, own in zip(body.parts, before.branches, strict=True)]
    numerical = _of_inertia(body, scheme, before, after, step) + _of_stress(body, scheme, before, after, step, change)
    pressed = _contact_work(body, scheme, before, after, change) - (standing[-1] - ledger.contact)
    return Energies(
        ledger.work + float(body.weight @ change),
        *standing,
        ledger.viscous + sum(heats),
        ledger.radiated + radiated,
        ledger.numerical + numerical + pressed,
    )


def _standing(body: BodyWithMass, state: BodyState) -> tuple[float, float, float, float]:
    """Energy in rigid and deformable motion, strain, contact."""
    v = state.velocity
    overlap = np.maximum(body.pressing.overlap(state.displacement), 0.0)
    springs = 0.5 * float((body.pressing.weights * state.pressure) @ overlap)
    strain = 0.5 * float(state.displacement @ state.internal)
    if not body.is_elastic:
        parts = zip(body.parts, state.branches, strict=True)
        strain = sum(part.stored(state.displacement, own) for part, own in parts)
    return 0.5 * float(body.rigid @ v**2), 0.5 * float(v @ (body.mass @ v)), strain, springs


def _of_inertia(body: BodyWithMass, scheme: Scheme, before: BodyState, after: BodyState, step: float) -> float:
    """Loss by the balance of inertia."""
    alpha_m, _, beta, gamma = scheme
    change, mean = after.acceleration - before.acceleration, (after.acceleration + before.acceleration) / 2
    pushed = body.inertia @ change
    swift = (before.velocity + after.velocity) / 2
    first = step * (1 - alpha_m - gamma) * float(swift @ pushed)
    return first + step**2 * (beta - gamma / 2) * float(pushed @ (mean + (0.5 - alpha_m) * change))


def _of_stress(
    body: BodyWithMass, scheme: Scheme, before: BodyState, after: BodyState, step: float, change: Array
) -> float:
    """Loss by stress and damping that are not averages over the step."""
    late, early = 1 - scheme.alpha_f, scheme.alpha_f
    forces = late * after.internal + early * before.internal - _average(body, before, after, step, change)
    if not (body.is_elastic or scheme.explicit):
        parts = zip(body.parts, before.branches, after.branches, strict=True)
        forces = forces + sum(p.later(p.law(step), z, own) for p, z, own in parts)
    if body.damping is not None:
        forces = forces + body.damping @ (late * after.velocity + early * before.velocity - change / step)
    return float(change @ forces)


def _average(body: BodyWithMass, before: BodyState, after: BodyState, step: float, change: Array) -> Array:
    """Nodal forces (N,) of the stress, over a step in which the displacement changes linearly."""
    if body.is_elastic:
        return 0.5 * (before.internal + after.internal)
    parts = zip(body.parts, before.branches, strict=True)
    means = [p.stiffness @ p.averaged(step, before.displacement, change, own) for p, own in parts]
    return np.asarray(sum(means, np.zeros(body.size)))


def _contact_work(body: BodyWithMass, scheme: Scheme, before: BodyState, after: BodyState, change: Array) -> float:
    """Work that the contact takes from the bodies."""
    pressure = (1 - scheme.alpha_f) * after.pressure + scheme.alpha_f * before.pressure
    return -float(change @ body.pressing.load(pressure))
