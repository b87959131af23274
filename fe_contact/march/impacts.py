"""Several impacts of one striker with one set of settings: contact, flight, contact on what the body remembers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from fe_contact.assembly.forms import Array
from fe_contact.errors import TooManySteps
from fe_contact.march.account import onwards
from fe_contact.march.flight import FAINTEST, Grounded, Landing, landing
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


def follow(
    strike: Strike,
    struck: Struck,
    impacts: int,
    placed: Callable[[int, Strike], Numerics],
    expected: Sequence[Sequence[float] | Array] = (),
    counted: Counted = uncounted,
) -> Followed:
    """Up to ``impacts`` contacts.

    Parameters
    ----------
    placed : settings for the contact of a number, from 0, and its strike, which say how long it is expected to last.
    expected : as of :func:`fe_contact.march.impact.march`, radii a contact.
    counted : told of every step.

    Raises the named failures of :mod:`fe_contact.errors` where a step does not converge.
    """
    contacts, begun, heat, steps = list[Contact](), strike, 0.0, 0
    while True:
        radii = expected[len(contacts)] if len(contacts) < len(expected) else ()
        stepper = struck.stepper(begun, placed(len(contacts), begun), radii)
        try:
            march = marched(stepper, counted)
        except TooManySteps:
            if not contacts:
                raise
            return Followed(tuple(contacts), Grounded.SWINGS)
        if contacts:
            march = replace(march, energy=onwards(march.energy, contacts[-1].march.energy, heat))
        contacts.append(Contact(begun, march))
        steps += march.work.steps
        if len(contacts) == impacts or not march.separated:
            return Followed(tuple(contacts), None)
        if steps > MOST_STEPS:
            return Followed(tuple(contacts), Grounded.MANY)
        touch = landing(stepper, march)
        if isinstance(touch, Grounded):
            return Followed(tuple(contacts), touch)
        if touch.velocity < FAINTEST * strike.velocity:
            return Followed(tuple(contacts), Grounded.REST)
        begun, heat = _again(begun, touch), touch.heat


def _again(strike: Strike, touch: Landing) -> Strike:
    """The strike that begins with a touch."""
    return replace(
        strike,
        velocity=touch.velocity,
        depth=touch.depth,
        memory=touch.memory,
        touched_at=strike.touched_at + touch.time,
        end_time=strike.end_time - touch.time,
    )
