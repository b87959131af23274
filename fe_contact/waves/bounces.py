"""Several impacts on a body with inertia: contact, flight, contact on what still moves and what is remembered."""

from __future__ import annotations

from dataclasses import dataclass, replace

from fe_contact.dynamics import ledger
from fe_contact.dynamics.march import MOST_WORK, Moment, Motion, Sample, onwards
from fe_contact.dynamics.state import undeformed
from fe_contact.errors import TooManySteps
from fe_contact.march.flight import FAINTEST, Grounded
from fe_contact.march.impacts import Contact, Followed
from fe_contact.progress import Counted, uncounted
from fe_contact.steppers.march import Strike
from fe_contact.waves.cost import MARCHES
from fe_contact.waves.flight import Flights
from fe_contact.waves.impact import choices_of, left, record
from fe_contact.waves.moving import Moving
from fe_contact.waves.numerics import WaveNumerics
from lumped.scene.scene import Scene

LONGEST = 12.0  # planned contact times after which one of several contacts counts as swinging on its weight
PATIENCE = 0.1  # of the steps along a contact that a flight takes before they double


@dataclass(frozen=True)
class Bounces(Followed):
    """The same of a body with inertia; ``steps`` and ``factorizations`` of the flights."""

    steps: int
    factorizations: int


def follow(
    moving: Moving, scene: Scene, strike: Strike, numerics: WaveNumerics, counted: Counted = uncounted
) -> Bounces:
    """Up to as many contacts as the scene asks for, the first one a ``strike`` on a body at rest; steps ``counted``.

    Raises the named failures of :mod:`fe_contact.errors` where a step does not converge.
    """
    flights = Flights(moving.body, choices_of(scene, numerics), max(round(PATIENCE * numerics.steps), 2), counted)
    still = undeformed(moving.body, moving.velocity)
    moment, contacts = Moment(still, ledger.opened(moving.body, still)), list[Contact]()

    def done(grounded: Grounded | None) -> Bounces:
        return Bounces(tuple(contacts), grounded, flights.steps, flights.factorizations)

    while True:
        try:
            found = _pressed(moving, moment, scene, strike, numerics, counted)
        except TooManySteps:
            if not contacts:
                raise
            return done(Grounded.SWINGS)
        march = record(moving, found, replace(scene, velocity=strike.velocity))
        contacts.append(Contact(strike, march))
        if len(contacts) == scene.motion.impacts or not march.separated:
            return done(None)
        if (flights.steps + sum(one.march.work.steps for one in contacts)) * moving.body.size > MOST_WORK / MARCHES:
            return done(Grounded.MANY)
        if scene.gravity <= 0.0:
            return done(Grounded.NO_GRAVITY)
        try:
            touch = flights.landing(Moment(found.final, found.samples[-1].energies), scene.end_time)
        except TooManySteps:
            return done(Grounded.MANY)
        if touch is None:
            return done(Grounded.LATE)
        strike = _again(strike, moving, touch, scene.end_time)
        if strike.velocity < FAINTEST * scene.velocity:
            return done(Grounded.CAUGHT if strike.velocity <= 0.0 else Grounded.REST)
        moment = touch


def _pressed(
    moving: Moving, begun: Moment, scene: Scene, strike: Strike, numerics: WaveNumerics, counted: Counted
) -> Motion:
    """One contact, by the clock of its touch; raises TooManySteps where one of several swings for too long."""
    longest = LONGEST * numerics.contact_time if scene.motion.impacts > 1 else strike.end_time
    until = min(longest, strike.end_time)

    def finished(sample: Sample) -> bool:
        counted(1.0)
        return left(sample)

    found = onwards(moving.body, begun, choices_of(scene, numerics), until, moving.watch, finished)
    if until < strike.end_time and not left(found.samples[-1]):
        raise TooManySteps(len(found.samples) - 1, found.final.time)
    clocked = tuple(sample._replace(time=sample.time - strike.touched_at) for sample in found.samples)
    return replace(found, samples=clocked)


def _again(strike: Strike, moving: Moving, touch: Moment, end_time: float) -> Strike:
    """The strike that begins with a touch."""
    state = touch.state
    depth, velocity = (float((moving.watch @ of)[0]) for of in (state.displacement, state.velocity))
    return replace(strike, velocity=velocity, depth=depth, touched_at=state.time, end_time=end_time - state.time)
