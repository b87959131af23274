"""Several impacts of one striker with one set of settings: contact, flight, contact on what the body remembers.

The loop is written once; what moves, with waves or without, is a :class:`Bouncer`.

From a separation to the next touch: the striker flies freely, the surface creeps back, gravity brings them together.

The first touch is where the last one was: what presses on the axis is never less than beside it, so that a surface in
recovery never stands higher there than the striker leaves it beside. Wherever that should fail, it is a named ending.

A surface that nothing presses any more: what it remembers creeps back freely, and exactly.

With the strains y_k = u - z_k of the dashpots, no stress means

    E_inf u + sum_k E_k (u - y_k) + eta du/dt = 0 ,    tau_k dy_k/dt = u - y_k ,

of which the retardation times theta_j of the creep compliance are the only times, as in
:class:`lumped.materials.Recovery`. Each has one mode, u = 1 and y_k = theta_j/(theta_j - tau_k); modes share no heat.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import NamedTuple, Protocol

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.bodies.memory import SurfaceMemory, product
from fe_contact.errors import TooManySteps
from fe_contact.march.impact import marched, onwards
from fe_contact.progress import Counted, uncounted
from fe_contact.settings import Numerics
from fe_contact.steppers.steps import March, Stepping, Strike
from fe_contact.steppers.struck import Struck
from lumped.materials import Relaxation

OFF_CENTRE = 1e-3  # share of the greatest depth by which surfaces may overlap elsewhere at touch
FAINTEST = 1e-6  # share of the velocity at the first touch below which bodies that meet again count as at rest
MOST_STEPS = 10_000  # after which no further contact is followed: a budget of some fifteen such rows takes a minute


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
    return float(brentq(gap, top, late, xtol=float(np.finfo(float).tiny)))


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


@dataclass(frozen=True)
class Contact:
    """One contact: its strike, begun by a touch, and its march, whose energies are all since the first touch."""

    strike: Strike
    march: March


@dataclass(frozen=True)
class Followed:
    """The contacts of a march in order, and why there are fewer than were asked for, None: there are not."""

    contacts: tuple[Contact, ...]
    grounded: Grounded | None


class Bouncer(Protocol):
    """What moves from one contact to the next."""

    def contact(self, strike: Strike) -> March:
        """The next contact. Raises TooManySteps where it swings for too long, NotReached where a step fails."""

    def touch(self, strike: Strike, march: March) -> Strike | Grounded:
        """The strike that begins after a contact, when striker and body meet again; or why there is none."""


def follow(bouncer: Bouncer, strike: Strike, impacts: int) -> Followed:
    """Up to ``impacts`` contacts, the first of them a ``strike`` on a body at rest.

    Raises the named failures of :mod:`fe_contact.errors` where a step of the first does not converge.
    """
    contacts, slowest = list[Contact](), FAINTEST * strike.velocity
    while True:
        try:
            march = bouncer.contact(strike)
        except TooManySteps:
            if not contacts:
                raise
            return Followed(tuple(contacts), Grounded.SWINGS)
        contacts.append(Contact(strike, march))
        if len(contacts) == impacts or not march.separated:
            return Followed(tuple(contacts), None)
        touch = bouncer.touch(strike, march)
        if isinstance(touch, Grounded):
            return Followed(tuple(contacts), touch)
        if touch.velocity < slowest:
            return Followed(tuple(contacts), Grounded.CAUGHT if touch.velocity <= 0.0 else Grounded.REST)
        strike = touch


class SurfaceBouncer:
    """A striker on a body that remembers by its surface alone, which recovers in flight.

    Parameters
    ----------
    placed : settings for the contact of a number, from 0, and its strike, which say how long it is expected to last.
    expected : as of :func:`fe_contact.march.impact.march`, radii a contact.
    counted : told of every step.
    """

    def __init__(
        self,
        struck: Struck,
        placed: Callable[[int, Strike], Numerics],
        expected: Sequence[Sequence[float] | Array] = (),
        counted: Counted = uncounted,
    ) -> None:
        self._struck, self._placed, self._expected, self._counted = struck, placed, expected, counted
        self._marches = list[March]()
        self._heat = 0.0  # of the surface in the last flight, J

    def contact(self, strike: Strike) -> March:
        """The next contact, its energies since the first touch."""
        number = len(self._marches)
        radii = self._expected[number] if number < len(self._expected) else ()
        self._stepper = self._struck.stepper(strike, self._placed(number, strike), radii)
        march = marched(self._stepper, self._counted)
        if self._marches:
            march = replace(march, energy=onwards(march.energy, self._marches[-1].energy, self._heat))
        self._marches.append(march)
        return march

    def touch(self, strike: Strike, march: March) -> Strike | Grounded:
        """Where the flight ends on the surface, which has crept back meanwhile."""
        if sum(one.work.steps for one in self._marches) > MOST_STEPS:
            return Grounded.MANY
        touch = landing(self._stepper, march)
        if isinstance(touch, Grounded):
            return touch
        self._heat = touch.heat
        return strike.again(touch.time, touch.depth, touch.velocity, touch.memory)
