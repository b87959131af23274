"""How a contact opens where it recedes: the gap behind its edge, as the pressure that would have kept it closed.

An elastic gap grows like the power 3/2 of the distance from the edge, which tells where that is. Behind an edge that
moves a gap is the younger the nearer it lies, and what has that power is not the gap g but

    E_inf g + sum_k E_k z_k + viscosity dg/dt ,    dz_k/dt = dg/dt - z_k/tau_k ,

over the time for which each place has been open: how far the elastic displacement of the pressure, smooth but for its
present edge, lies from what holds the surface on the striker (Ting 1966, doi:10.1115/1.3625192).
"""

from __future__ import annotations

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.bodies.memory import StepLaw, SurfaceMemory


def just_open(gap: Array, branches: int) -> SurfaceMemory:
    """What is open, (q,), m, as the contact turns: the edge has left it only for a moment, and all springs feel it."""
    gap = np.maximum(gap, 0.0)
    return SurfaceMemory(np.ones_like(gap), gap[None], np.tile(gap, (branches, 1, 1)))


def opened(memory: SurfaceMemory, law: StepLaw, gap: Array) -> tuple[SurfaceMemory, Array]:
    """The memory after a step that leads to a gap (q,), m, and gap times modulus in the step, (q,), Pa m."""
    now = np.maximum(gap, 0.0)[None]
    return memory.advanced(law, now), (law.now * now + memory.carried(law))[0]
