"""One contact after another: between them the bodies fly freely, and gravity may bring them back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lumped.result.history import End
from lumped.solvers.point.bodies import Bodies, PointLaw
from lumped.solvers.point.contact import Contact, contact

# Contacts whose velocity at touch is below this share of the first one's: the bodies count as at rest.
FAINTEST = 1e-6


@dataclass(frozen=True)
class PointMotion:
    """Contacts in order; between two of them depth is that of free flight. `gravity`: m/s2 towards the target."""

    contacts: tuple[Contact, ...]
    gravity: float

    @property
    def end(self) -> End:
        """How the last contact ended."""
        return self.contacts[-1].end

    @property
    def steps(self) -> int:
        """How many it took."""
        return sum(len(phase.steps) for one in self.contacts for phase in one.phases)


def motion(law: PointLaw, bodies: Bodies, exit_rule: str, impacts: int, until: float, tolerance: float) -> PointMotion:
    """Up to `impacts` contacts, the first at time zero, followed until `until`, s. Raises TooManySteps."""
    state, time, contacts = law.touch(bodies), 0.0, list[Contact]()
    while len(contacts) < impacts:
        # A trial of Newton's method may go beyond all numbers: then the step is refused.
        with np.errstate(all="ignore"):
            contacts.append(contact(law, bodies, exit_rule, state, time, until, tolerance))
        if contacts[-1].end is not End.SEPARATED:
            break
        again = law.returned(bodies, contacts[-1].last)
        if again is None or contacts[-1].end_time + again[0] >= until:
            break
        time, state = contacts[-1].end_time + again[0], again[1]
        if abs(state.rate) < FAINTEST * bodies.velocity:
            break
    return PointMotion(tuple(contacts), bodies.gravity)
