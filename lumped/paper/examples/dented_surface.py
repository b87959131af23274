"""What Fig. 15 is about: the dent left when the ball parts, how it comes back, and a second impact before it has.

The surface is the 3-parameter solid, left to itself out of contact: its load y = depth^alpha falls as exp(-t/R2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lumped.laws.correspondence import HereditaryForce, law_of
from lumped.materials.networks import sls
from lumped.paper.examples.given import Steel
from lumped.paper.examples.steel_impacts import TOLERANCE, scene
from lumped.solvers.point.bodies import Bodies, State
from lumped.solvers.point.contact import Contact, PointMotion, contact
from lumped.solvers.point.memory.recovering import FreeSurface
from lumped.solvers.point.track import Outcome, PointTrack, outcome_of

Array = NDArray[np.float64]
EXPONENT = 1.5


@dataclass(frozen=True)
class DentedSurface:
    """The steel ball's first impact on a solid with R1 and R2, s, and the surface after it."""

    steel: Steel
    R1: float
    R2: float

    @cached_property
    def first(self) -> Outcome:
        """The impact on the flat surface. Raises TooManySteps."""
        return outcome_of(*self._track(self._contact))

    @property
    def parting(self) -> float:
        """When the ball and the surface part, s."""
        return self._contact.end_time

    def ball(self, times: Array) -> Array:
        """Depth of the ball at times (n,) since touch, s, m: it flies freely once it has parted."""
        track, _ = self._track(self._contact)
        return np.asarray(track(times)[0])

    def surface(self, times: Array) -> Array:
        """Depth of the surface under the ball's tip at times (n,) since touch, s, m."""
        found = self.ball(times)
        for i in np.flatnonzero(times > self.parting):
            found[i] = self._left(float(times[i]) - self.parting).depth
        return found

    def second(self, pause: float) -> Outcome:
        """The impact of an equal ball that meets the surface a pause, s, after the parting. Raises TooManySteps."""
        return outcome_of(*self._track(self._strike(self._left(pause))))

    @cached_property
    def _law(self) -> HereditaryForce:
        return law_of(scene(self.steel, sls.of_ratios(E0=self.steel.contact_modulus, R1=self.R1, R2=self.R2)))

    @cached_property
    def _contact(self) -> Contact:
        return self._strike(State(0.0, self.steel.velocity, 0.0, self._law.load.at_rest))

    def _strike(self, start: State) -> Contact:
        bodies = Bodies(self.steel.mass, self.steel.velocity)
        return contact(self._law, bodies, self._law.exit, start, 0.0, math.inf, TOLERANCE)

    def _track(self, one: Contact) -> tuple[PointTrack, Contact]:
        return PointTrack(self._law, PointMotion((one,), 0.0)), one

    def _left(self, pause: float) -> State:
        """The state in which the next ball finds the surface."""
        last = self._contact.last
        load, *memory = FreeSurface.of(self._law.load, last).at(pause).tolist()
        depth = last.depth * (max(load, 0.0) / float(self._law.load.load(last.depth))) ** (1.0 / EXPONENT)
        return State(depth, self.steel.velocity, 0.0, tuple(memory))
