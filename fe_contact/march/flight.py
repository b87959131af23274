"""From a separation to the next touch: the striker flies freely, the surface creeps back, gravity brings them together.

The first touch is where the last one was: what presses on the axis is never less than beside it, so that a surface in
recovery never stands higher there than the striker leaves it beside. Wherever that should fail, it is a named ending.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from typing import NamedTuple

import numpy as np

from fe_contact.bodies.memory import SurfaceMemory
from fe_contact.bodies.released import Released
from fe_contact.steppers.march import March, Strike
from fe_contact.steppers.steps import Stepping

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
