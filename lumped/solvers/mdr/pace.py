"""How long the steps are: by the error they make, or as they were before, each cut into equal parts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

from lumped.solvers.mdr.row import Instant

GROWTH = 3.0
CAUTION = 0.9
SHRINKAGE = 0.2
# Below this share of the velocity at touch, errors of the velocity count absolutely.
REST = 1e-5
# Once the contact has shrunk to this share of its reach, its edge may run to the axis in any step.
NEARLY_CLOSED = 0.1
OVERREACH = 1.5


class Pace(Protocol):
    """Says how long the next step is to be, and whether a tried one may be taken."""

    def propose(self, now: Instant) -> float:
        """Length of the next step, s."""

    def accepts(self, now: Instant, then: Instant) -> bool:
        """Whether a step from `now` to `then` may be taken; if not, `propose` answers with a shorter one."""


@dataclass
class Adaptive:
    """Steps that keep the error of the velocity below `tolerance` of it, and the edge's travel below 1/elements.

    The error of a step is h^3 a''/12, a'' from the accelerations at three instants. `reach`, m: the contact
    radius which `elements` steps are to cover at least.
    """

    first: float
    elements: int
    reach: float
    velocity: float
    tolerance: float = field(init=False)
    before: Instant | None = None
    h: float = field(init=False)

    def __post_init__(self) -> None:
        # A half sine of acceleration errs by this per step at 0.6 `elements` steps per contact.
        self.tolerance = 12.0 / self.elements**3
        self.h = self.first

    def propose(self, now: Instant) -> float:
        return self.h

    def accepts(self, now: Instant, then: Instant) -> bool:
        h = then.time - now.time
        # An error grows as h^3, the travel as h: cubed, both ask for a step in the same way.
        share = max(self._error(now, then, h), (CAUTION * self._travel(now, then)) ** 3)
        factor = GROWTH if share <= 0.0 else min(GROWTH, max(SHRINKAGE, CAUTION * share ** (-1.0 / 3.0)))
        self.h = h * factor
        if share > 2.0:
            return False
        self.before = now
        return True

    def _error(self, now: Instant, then: Instant, h: float) -> float:
        """Estimated error of the step over the tolerance."""
        return 0.0 if self.before is None else self.error(self.before, now, then)

    def error(self, before: Instant, now: Instant, then: Instant) -> float:
        """Estimated error of the step between the last two of three instants over the tolerance."""
        h, back = then.time - now.time, now.time - before.time
        if not h > 0.0 or not back > 0.0:
            return 0.0
        bend = (then.acceleration - now.acceleration) / h - (now.acceleration - before.acceleration) / back
        scale = max(abs(now.velocity), abs(then.velocity), REST * self.velocity)
        return abs(h**3 * bend / (6.0 * (h + back))) / (self.tolerance * scale)

    def _travel(self, now: Instant, then: Instant) -> float:
        """The edge's travel over its allowance."""
        if then.edge < now.edge and then.edge < NEARLY_CLOSED * self.reach:
            return 0.0
        allowed = max(now.edge, then.edge, self.reach) / self.elements
        return abs(then.edge - now.edge) / allowed


@dataclass
class Prescribed:
    """Steps that end at given instants, s; the last reaches beyond its own, for the event that cuts it."""

    instants: Sequence[float]
    taken: int = 0

    def propose(self, now: Instant) -> float:
        if self.taken < len(self.instants) - 1:
            return self.instants[self.taken] - now.time
        return OVERREACH * (self.instants[-1] - (self.instants[-2] if len(self.instants) > 1 else 0.0))

    def accepts(self, now: Instant, then: Instant) -> bool:
        self.taken += 1
        return True
