"""One contact after another: between them the bodies fly freely, and gravity may bring them back."""

from __future__ import annotations

import math
from dataclasses import dataclass

from lumped.collide.bodies import Bodies, PointLaw, Stage, State
from lumped.collide.contact import Contact, contact
from lumped.ending import End

BISECTIONS = 200
# Contacts whose velocity at touch is below this share of the first one's: the bodies count as at rest.
FAINTEST = 1e-6


@dataclass(frozen=True)
class Motion:
    """Contacts in order; between two of them depth is that of free flight. `gravity`: m/s2 towards the target."""

    contacts: tuple[Contact, ...]
    gravity: float

    @property
    def end(self) -> End:
        """How the last contact ended."""
        return self.contacts[-1].end


def motion(
    law: PointLaw, bodies: Bodies, exit_rule: str, impacts: int, until: float, tolerance: float
) -> Motion:
    """Up to `impacts` contacts, the first at time zero, followed until `until`, s. Raises TooManySteps."""
    state, time, contacts = State(0.0, bodies.velocity, 0.0), 0.0, list[Contact]()
    while len(contacts) < impacts:
        contacts.append(contact(law, bodies, exit_rule, state, time, until, tolerance))
        if contacts[-1].end is not End.SEPARATED:
            break
        flight = flight_time(law, bodies, contacts[-1].last)
        if flight is None or contacts[-1].end_time + flight >= until:
            break
        time = contacts[-1].end_time + flight
        state = flown(contacts[-1].last, bodies.gravity, flight)
        if abs(state.rate) < FAINTEST * bodies.velocity:
            break
    return Motion(tuple(contacts), bodies.gravity)


def flown(state: State, gravity: float, time: float) -> State:
    """The state after free flight of `time`, s."""
    depth = state.depth + time * (state.rate + 0.5 * gravity * time)
    return State(depth, state.rate + gravity * time, state.lost)


def flight_time(law: PointLaw, bodies: Bodies, last: State) -> float | None:
    """How long the bodies are apart, s; None for ever.

    They meet again at depth zero; where gravity turns them before they have left the dent, when the force of
    the law rises above zero.
    """
    gravity = bodies.gravity
    if gravity <= 0.0:
        return None
    top = -last.rate / gravity
    highest = flown(last, gravity, top).depth
    if highest <= 0.0:
        return top + math.sqrt(-2.0 * highest / gravity)
    stage = Stage(False, last.depth, bodies.velocity)
    low, high = 0.0, top
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        there = flown(last, gravity, middle)
        low, high = (low, middle) if law.force(there.depth, there.rate, stage) <= 0.0 else (middle, high)
    return high
