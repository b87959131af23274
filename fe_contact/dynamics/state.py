"""What a march carries from step to step."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.assembly.interior import factorized
from fe_contact.dynamics import memory
from fe_contact.dynamics.body import BodyWithMass


class BodyState(NamedTuple):
    """A body at an instant, s, with N degrees of freedom and q points of contact, SI units.

    ``displacement``, ``velocity``, ``acceleration`` (N,); ``branches`` of every part, (k, N); ``internal`` (N,) nodal
    forces of the stress, without damping; ``signed_pressure`` (q,), negative where open.
    """

    time: float
    displacement: Array
    velocity: Array
    acceleration: Array
    branches: tuple[Array, ...]
    internal: Array
    signed_pressure: Array

    @property
    def pressure(self) -> Array:
        """Contact pressure at the points, (q,), >= 0."""
        return np.maximum(self.signed_pressure, 0.0)


def undeformed(body: BodyWithMass, velocity: Array) -> BodyState:
    """A relaxed body about to touch, moving with ``velocity`` (N,); its acceleration balances gravity and damping."""
    displacement = np.zeros(body.size)
    branches = tuple(np.zeros((len(part.relaxation.moduli), body.size)) for part in body.parts)
    forces = body.weight if body.damping is None else body.weight - body.damping @ velocity
    acceleration = np.zeros(body.size)
    free = body.massive
    acceleration[free] = factorized(body.inertia[free][:, free])(forces[free])
    open_points = -np.ones(body.pressing.weights.size)
    return BodyState(
        0.0, displacement, velocity, acceleration, branches, internal(body, displacement, branches), open_points
    )


def internal(body: BodyWithMass, displacement: Array, branches: tuple[Array, ...]) -> Array:
    """Nodal forces of the stress, (N,), N."""
    parts = zip(body.parts, branches, strict=True)
    forces = [part.stiffness @ memory.stressed(part, displacement, own) for part, own in parts]
    return np.asarray(sum(forces, np.zeros(body.size)))
