"""From contact to contact of a body with inertia, on what still moves and what is remembered.

A flight between two contacts of a body with inertia: the striker falls, waves leave, what the body remembers fades.

Nothing presses, and what still moves does so the more slowly the longer ago the separation is: steps grow with that
time, and the longest flight takes no more of them than its logarithm asks for. A step in which the surfaces meet is
taken back and halved, down to that of the contacts, within which the touch is located and stepped to. The striker's
depth is convex in time: between two open ends of a step only a surface could meet it that comes and goes within it,
and that is past while steps are still short.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fe_contact.assembly.cache import Store
from fe_contact.dynamics import events, ledger
from fe_contact.dynamics.body import BodyWithMass
from fe_contact.dynamics.implicit import ImplicitStepper
from fe_contact.dynamics.march import MOST_WORK, Choices, Moment, Sample, onwards
from fe_contact.dynamics.schemes import generalised_alpha
from fe_contact.dynamics.state import BodyState, undeformed
from fe_contact.errors import TooManySteps
from fe_contact.march.flight import Grounded
from fe_contact.progress import Counted, uncounted
from fe_contact.settings import WaveNumerics
from fe_contact.steppers.march import March, Strike
from fe_contact.waves.cost import MARCHES
from fe_contact.waves.impact import choices_of, left, record
from fe_contact.waves.moving import Moving
from lumped.scene.scene import Scene

LONGEST = 12.0  # planned contact times after which one of several contacts counts as swinging on its weight
PATIENCE = 0.1  # of the steps along a contact that a flight takes before they double
DAMPED = generalised_alpha.of(0.5)  # waves that no step follows any more die away, by half a step
KEPT = 8  # lengths of step whose factors are kept, some 10 MB each
LOCATED = 1e-6  # of a step: a touch sooner than that is now


class WaveBouncer:
    """A striker on a body with inertia, from the first touch of a ``scene`` on; steps ``counted``.

    ``flights``: what they took.
    """

    def __init__(self, moving: Moving, scene: Scene, numerics: WaveNumerics, counted: Counted = uncounted) -> None:
        self._moving, self._scene, self._counted = moving, scene, counted
        self._choices, self._longest = choices_of(scene, numerics), LONGEST * numerics.contact_time
        self.flights = Flights(moving.body, self._choices, max(round(PATIENCE * numerics.steps), 2), counted)
        still = undeformed(moving.body, moving.velocity)
        self._moment = Moment(still, ledger.opened(moving.body, still))
        self._steps = 0

    def contact(self, strike: Strike) -> March:
        """The next contact, by the clock of its touch; one of several that swings for long takes too many steps."""
        several = self._scene.motion.impacts > 1
        until = min(self._longest, strike.end_time) if several else strike.end_time

        def finished(sample: Sample) -> bool:
            self._counted(1.0)
            return left(sample)

        body, watch = self._moving.body, self._moving.watch
        found = onwards(body, self._moment, self._choices, until, watch, finished)
        if until < strike.end_time and not left(found.samples[-1]):
            raise TooManySteps(len(found.samples) - 1, found.final.time)
        clocked = tuple(sample._replace(time=sample.time - strike.touched_at) for sample in found.samples)
        march = record(self._moving, replace(found, samples=clocked), replace(self._scene, velocity=strike.velocity))
        self._moment, self._steps = Moment(found.final, found.samples[-1].energies), self._steps + march.work.steps
        return march

    def touch(self, strike: Strike, march: March) -> Strike | Grounded:
        """Where the flight ends on what still moves."""
        scene, body = self._scene, self._moving.body
        if (self.flights.steps + self._steps) * body.size > MOST_WORK / MARCHES:
            return Grounded.MANY
        if scene.gravity <= 0.0:
            return Grounded.NO_GRAVITY
        try:
            touch = self.flights.landing(self._moment, scene.end_time)
        except TooManySteps:
            return Grounded.MANY
        if touch is None:
            return Grounded.LATE
        self._moment, state = touch, touch.state
        depth, velocity = (float((self._moving.watch @ of)[0]) for of in (state.displacement, state.velocity))
        return strike.again(state.time - strike.touched_at, depth, velocity)


class Flights:
    """Flights of one body, their first steps as long as those of the contacts; every ``patience`` steps they double.

    ``steps`` taken, ``factorizations`` made so far, of which the last ones used are kept; steps are ``counted``.
    """

    def __init__(self, body: BodyWithMass, choices: Choices, patience: int, counted: Counted = uncounted) -> None:
        self._counted, self._most = counted, MOST_WORK / body.size
        self._body, self._choices, self._patience = body, choices, patience
        self._steppers = Store(KEPT)
        self.steps = self.factorizations = 0

    def landing(self, parted: Moment, until: float) -> Moment | None:
        """The touch that follows a separation; None where ``until``, s, comes before. Raises TooManySteps."""
        moment, level, highest, taken = parted, 0, np.inf, 0
        while moment.state.time < until:
            state = self._flown(moment, self._stepper(level))
            if not _met(state):
                moment, taken = self._entered(moment, state), taken + 1
                if taken >= self._patience and level < highest:
                    level, taken = level + 1, 0
            elif level:
                level, taken = level - 1, 0
                highest = level
            else:
                return self._touched(moment)
        return None

    def _touched(self, moment: Moment) -> Moment:
        """The touch within the next of the shortest steps; nothing presses yet, though a rounding may overlap."""
        state, pressing, step = moment.state, self._body.pressing, self._choices.step
        overlap, closing = pressing.overlap(state.displacement), pressing.closing(state.velocity)
        left = events.touched(state.time, step, overlap, closing) - state.time
        if left <= LOCATED * step:
            return moment
        touch = self._flown(moment, self._made(left))
        open_yet = np.minimum(touch.signed_pressure, 0.0)
        return self._entered(moment, touch._replace(signed_pressure=open_yet))

    def _flown(self, moment: Moment, stepper: ImplicitStepper) -> BodyState:
        """A step later, whether or not anything meets in it. Raises TooManySteps."""
        if self.steps >= self._most:
            raise TooManySteps(self.steps, moment.state.time)
        self.steps += 1
        self._counted(1.0)
        return stepper.flown(moment.state)

    def _entered(self, moment: Moment, state: BodyState) -> Moment:
        """A step further in the ledger too."""
        return Moment(state, ledger.entered(moment.energies, self._body, DAMPED, moment.state, state))

    def _stepper(self, level: int) -> ImplicitStepper:
        """Of steps 2^level as long as the first."""
        return self._steppers.find((level,), lambda: self._made(2.0**level * self._choices.step))

    def _made(self, step: float) -> ImplicitStepper:
        self.factorizations += 1
        return ImplicitStepper(self._body, DAMPED, self._choices.enforced, step)


def _met(state: BodyState) -> bool:
    """Whether the surfaces overlap anywhere."""
    return bool(state.signed_pressure.max() > 0.0)
