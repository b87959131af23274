"""From a separation to the next touch: the striker flies freely, the surface creeps back, gravity brings them together.

The first touch is where the last one was: what presses on the axis is never less than beside it, so that a surface in
recovery never stands higher there than the striker leaves it beside. Wherever that should fail, it is a named ending.

A surface that nothing presses any more: what it remembers creeps back freely, and exactly.

With the strains y_k = u - z_k of the dashpots, no stress means

    E_inf u + sum_k E_k (u - y_k) + eta du/dt = 0 ,    tau_k dy_k/dt = u - y_k ,

of which the retardation times theta_j of the creep compliance are the only times, as in
:class:`lumped.materials.Recovery`. Each has one mode, u = 1 and y_k = theta_j/(theta_j - tau_k); modes share no heat.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.bodies.memory import SurfaceMemory, product
from fe_contact.steppers.march import March, Strike
from fe_contact.steppers.steps import Stepping
from lumped.materials import Relaxation

OFF_CENTRE = 1e-3  # share of the greatest depth by which surfaces may overlap elsewhere at touch
FAINTEST = 1e-6  # share of the velocity at the first touch below which bodies that meet again count as at rest


class Grounded(Enum):
    """Why no further contact is followed; the value says so to the user."""

    NO_GRAVITY = "without model.gravity the striker does not come back"
    LATE = "motion.end_time comes before the next touch"
    CAUGHT = "the recovering surface meets a striker that still rises, which is not followed"
    OFF_CENTRE = "the next touch is off the centre of the last contact, which is not followed"
    SWINGS = "the next one swings on its weight for more steps than are allowed; cure: an earlier motion.end_time"
    MANY = "more of them take more steps than are allowed; cure: fewer motion.impacts"
    REST = "the striker has come to rest"


UNFOLLOWED = (Grounded.CAUGHT, Grounded.OFF_CENTRE, Grounded.SWINGS, Grounded.MANY)


class Landing(NamedTuple):
    """The next touch: s since the last one, m, m/s, the surface's memory; heat of the surface during the flight, J."""

    time: float
    depth: float
    velocity: float
    memory: SurfaceMemory
    heat: float


def landing(stepper: Stepping, march: March) -> Landing | Grounded:
    """The touch that follows a march which has separated."""
    strike = stepper.strike
    if strike.gravity <= 0.0:
        return Grounded.NO_GRAVITY
    released, place = Released.of(strike.relaxation, stepper.remembered(march.memory)), stepper.standing()
    parted, velocity = float(march.time[-1]), leaving(strike, march)
    since = parted - march.memory_time

    def depth(flown: float) -> float:
        return float(march.depth[-1]) + flown * (velocity + 0.5 * strike.gravity * flown)

    flown = _fallen(lambda t: released.displacement(place, since + t) - depth(t), -velocity / strike.gravity)
    if flown is None:
        return Grounded.CAUGHT
    if parted + flown >= strike.end_time:
        return Grounded.LATE
    surface = released.after(since + flown)
    if stepper.clearance(surface, depth(flown)).min() < -OFF_CENTRE * march.depth.max():
        return Grounded.OFF_CENTRE
    heat = released.dissipated(since + flown) - released.dissipated(since)
    faster = velocity + strike.gravity * flown
    return Landing(parted + flown, depth(flown), faster, surface, heat)


def leaving(strike: Strike, march: March) -> float:
    """Velocity at the end of a march, by the balance of momentum, m/s."""
    return float(strike.velocity + strike.gravity * march.time[-1] - march.impulse[-1] / strike.mass)


def _fallen(gap: Callable[[float], float], top: float) -> float | None:
    """When the gap, m, over the time of flight, s, closes after the top; None where it is closed by then."""
    from scipy.optimize import brentq  # late: a single impact needs no roots

    if gap(top) <= 0.0:
        return None
    late = 2.0 * top
    while gap(late) > 0.0:
        late *= 2.0
    return float(brentq(gap, top, late, xtol=float(np.finfo(float).tiny), rtol=1e-14))


@dataclass(frozen=True, eq=False)
class Released:
    """What is left of a memory over the time since nothing presses, s.

    ``permanent`` (f, r) and ``amplitudes`` (j, f, r) of the displacement u, and of the pressure that would hold it
    elastically with unit modulus; ``times``, s, and ``compliances``, 1/Pa, (j,) of the creep; ``springs`` (k, j): z_k
    of a mode with u = 1.
    """

    areas: Array
    permanent: Array
    amplitudes: Array
    times: Array
    springs: Array
    compliances: Array

    @classmethod
    def of(cls, relaxation: Relaxation, memory: SurfaceMemory) -> Released:
        """From a memory, whose springs let go of what they still press with."""
        creep, moduli, taus = relaxation.creep(), np.array(relaxation.moduli), np.array(relaxation.times)
        kept = np.array(creep.compliances) > 0.0
        compliances, times = np.array(creep.compliances)[kept], np.array(creep.times)[kept]
        apart = 1.0 - taus[:, None] / times
        # a branch too weak to tell retardation from relaxation holds nothing back
        dashpots = np.divide(1.0, apart, out=np.zeros_like(apart), where=apart != 0.0)
        damped = relaxation.viscosity * memory.strain
        pulls = (moduli * taus)[:, None, None] * (memory.strain - memory.branches)
        released = np.tensordot(dashpots.T, pulls, 1) + damped
        amplitudes = (compliances / times)[:, None, None] * released
        permanent = creep.fluidity * (pulls.sum(axis=0) + damped)
        return cls(memory.areas, permanent, amplitudes, times, 1.0 - dashpots, compliances)

    def displacement(self, place: int, time: float) -> float:
        """At one place of the memory, m."""
        return float(self.permanent[0, place] + np.exp(-time / self.times) @ self.amplitudes[:, 0, place])

    def after(self, time: float) -> SurfaceMemory:
        """The memory after a time, s."""
        left = np.exp(-time / self.times)[:, None, None] * self.amplitudes
        return SurfaceMemory(self.areas, self.permanent + left.sum(axis=0), np.tensordot(self.springs, left, 1))

    def dissipated(self, time: float) -> float:
        """Heat of a time, s: of each mode what its springs held, theta/C (u p) / theta / 2; J."""
        gone = -np.expm1(-2.0 * time / self.times) / self.compliances
        held = np.array([product(self.areas, mode, mode) for mode in self.amplitudes])
        return 0.5 * float(gone @ held)
