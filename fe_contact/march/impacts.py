"""Several impacts of one striker with one set of settings: contact, flight, contact on what the body remembers.

The loop is written once; what moves, with waves or without, is a :class:`Bouncer`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from fe_contact.assembly.forms import Array
from fe_contact.errors import TooManySteps
from fe_contact.march.account import onwards
from fe_contact.march.flight import FAINTEST, Grounded, landing
from fe_contact.march.impact import marched
from fe_contact.progress import Counted, uncounted
from fe_contact.settings import Numerics
from fe_contact.steppers.march import March, Strike
from fe_contact.steppers.struck import Struck

MOST_STEPS = 10_000  # after which no further contact is followed: a budget of some fifteen such rows takes a minute


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
