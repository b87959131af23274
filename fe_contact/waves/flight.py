"""A flight between two contacts of a body with inertia: the striker falls, waves leave, what the body remembers fades.

Nothing presses, and what still moves does so the more slowly the longer ago the separation is: steps grow with that
time, and the longest flight takes no more of them than its logarithm asks for. A step in which the surfaces meet is
taken back and halved, down to that of the contacts, within which the touch is located and stepped to. The striker's
depth is convex in time: between two open ends of a step only a surface could meet it that comes and goes within it,
and that is past while steps are still short.
"""

from __future__ import annotations

import numpy as np

from fe_contact.assembly.cache import Store
from fe_contact.dynamics import events, ledger
from fe_contact.dynamics.body import Body
from fe_contact.dynamics.implicit import ImplicitStepper
from fe_contact.dynamics.march import MOST_WORK, Choices, Moment
from fe_contact.dynamics.schemes import generalised_alpha
from fe_contact.dynamics.state import State
from fe_contact.errors import TooManySteps
from fe_contact.progress import Counted, uncounted

DAMPED = generalised_alpha.of(0.5)  # waves that no step follows any more die away, by half a step
KEPT = 8  # lengths of step whose factors are kept, some 10 MB each
LOCATED = 1e-6  # of a step: a touch sooner than that is now


class Flights:
    """Flights of one body, their first steps as long as those of the contacts; every ``patience`` steps they double.

    ``steps`` taken, ``factorizations`` made so far, of which the last ones used are kept; steps are ``counted``.
    """

    def __init__(self, body: Body, choices: Choices, patience: int, counted: Counted = uncounted) -> None:
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

    def _flown(self, moment: Moment, stepper: ImplicitStepper) -> State:
        """A step later, whether or not anything meets in it. Raises TooManySteps."""
        if self.steps >= self._most:
            raise TooManySteps(self.steps, moment.state.time)
        self.steps += 1
        self._counted(1.0)
        return stepper.flown(moment.state)

    def _entered(self, moment: Moment, state: State) -> Moment:
        """A step further in the ledger too."""
        return Moment(state, ledger.entered(moment.energies, self._body, DAMPED, moment.state, state))

    def _stepper(self, level: int) -> ImplicitStepper:
        """Of steps 2^level as long as the first."""
        return self._steppers.find((level,), lambda: self._made(2.0**level * self._choices.step))

    def _made(self, step: float) -> ImplicitStepper:
        self.factorizations += 1
        return ImplicitStepper(self._body, DAMPED, self._choices.enforced, step)


def _met(state: State) -> bool:
    """Whether the surfaces overlap anywhere."""
    return bool(state.signed_pressure.max() > 0.0)
