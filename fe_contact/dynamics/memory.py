"""What the bulk remembers: one field of nodal displacements for every branch of the relaxation modulus.

The displacement is linear in time within a step, so that every branch is integrated exactly:

    stress = E_inf u + sum_k E_k z_k ,    dz_k/dt = du/dt - z_k/tau_k ,

with the stiffness matrix of unit modulus behind it. A parallel viscosity counts among the dampings.

Under a velocity that grows, a branch so integrated lags behind the exact one by a share of the step that goes from none
to one half as the step outgrows tau. An implicit balance asks for branches so much later, which keeps it of order two.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.dynamics.body import Part
from fe_contact.schemes import galerkin

SLOW = 1e-3  # step over relaxation time below which the lag is a twelfth of that, to rounding


class PartLaw(NamedTuple):
    """Numbers of one part in a step of one length: ``now`` modulus of an increment; z' = decay z + gain (u' - u);
    ``late`` what z' - z counts for to make up for the lag, Pa.
    """

    now: float
    decay: Array
    gain: Array
    late: Array


def part_law(part: Part, step: float) -> PartLaw:
    """Numbers of a step, s."""
    ratios = step / np.asarray(part.relaxation.times)
    lost = np.expm1(-ratios)
    gain = -lost / ratios
    now = part.relaxation.equilibrium + float(np.dot(part.relaxation.moduli, gain))
    lag = np.where(ratios < SLOW, ratios / 12.0, -1.0 / lost - 0.5 - 1.0 / ratios)
    return PartLaw(now, 1.0 + lost, gain, np.asarray(part.relaxation.moduli) * lag)


def later(part: Part, law: PartLaw, before: Array, after: Array) -> Array:
    """Nodal forces (N,) that make up for the lag, of branches (k, N) at both ends of a step."""
    return np.asarray(part.stiffness @ (law.late @ (after - before)))


def past(part: Part, law: PartLaw, displacement: Array, branches: Array) -> Array:
    """Displacement times modulus, (N,), at the end of a step in which nothing moves; ``branches`` (k, N)."""
    relaxation = part.relaxation
    return np.asarray(relaxation.equilibrium * displacement + (law.decay * relaxation.moduli) @ branches)


def stressed(part: Part, displacement: Array, branches: Array) -> Array:
    """Displacement times modulus at an instant, (N,)."""
    return np.asarray(part.relaxation.equilibrium * displacement + np.asarray(part.relaxation.moduli) @ branches)


def averaged(part: Part, step: float, displacement: Array, change: Array, branches: Array) -> Array:
    """Displacement times modulus, average over a step in which the displacement (N,) grows by ``change``, (N,)."""
    relaxation = part.relaxation
    of_change, of_past = galerkin.weights(np.asarray(relaxation.moduli), step / np.asarray(relaxation.times))
    held = relaxation.equilibrium * (displacement + change / 2)
    return np.asarray(held + of_change.sum() * change + of_past @ branches)


def stored(part: Part, displacement: Array, branches: Array) -> float:
    """Elastic energy of springs and branches, J."""
    relaxation = part.relaxation
    equilibrium = relaxation.equilibrium * float(displacement @ (part.stiffness @ displacement))
    energies = [float(branch @ (part.stiffness @ branch)) for branch in branches]
    return 0.5 * (equilibrium + float(np.dot(relaxation.moduli, energies)))


def heat(part: Part, step: float, change: Array, branches: Array) -> float:
    """Heat of the dashpots over a step in which the displacement changes linearly, J."""
    if part.relaxation.is_elastic:
        return 0.0
    relaxation, pulled = part.relaxation, part.stiffness @ change
    pull = float(change @ pulled)
    lost = relaxation.viscosity * pull / step
    for modulus, tau, branch in zip(relaxation.moduli, relaxation.times, branches, strict=True):
        x, share = step / tau, tau / step  # the branch tends to share x change; the rest fades away
        across = float(branch @ pulled)
        fading = float(branch @ (part.stiffness @ branch)) - 2 * share * across + share**2 * pull
        mixed = share * across - share**2 * pull
        lost += modulus * (fading * -np.expm1(-2 * x) / 2 + 2 * mixed * -np.expm1(-x) + share**2 * pull * x)
    return lost
