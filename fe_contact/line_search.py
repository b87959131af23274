"""The line search of the contact problem: a step of Newton's method that does not lessen the energy is shortened."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fe_contact.forms import Array

if TYPE_CHECKING:
    from fe_contact.contact import ContactProblem

ENERGY_ROUNDING = 1e-15  # a change of the energy below this share is rounding
SHORTEST = 1e-10  # share of a step below which the energy stands still


@dataclass(frozen=True, eq=False)
class Point:
    """A place between Newton's points: forces (q,) that displace the surface, striker's retreat, gap (q,)."""

    forces: Array
    retreat: float
    gap: Array

    def towards(self, other: Point, share: float) -> Point:
        """The point at a share of the way to another."""
        return Point(
            self.forces + share * (other.forces - self.forces),
            self.retreat + share * (other.retreat - self.retreat),
            self.gap + share * (other.gap - self.gap),
        )

    def energy(self, problem: ContactProblem) -> float:
        """J of :mod:`fe_contact.contact`."""
        strain = problem.surface.work(self.forces)
        striker = self.retreat**2 / float(problem.yielding) if problem.yielding else 0.0
        pressed = problem.surface.weights @ np.maximum(self.gap, 0.0) ** 2
        return 0.5 * (strain + striker + problem.penalty * float(pressed))


def descended(problem: ContactProblem, start: Point, end: Point) -> tuple[Point, bool]:
    """The end, or the nearest point towards it of less energy than the start; whether the energy stands still."""
    energy = start.energy(problem)
    point, lowest, share = end, end.energy(problem), 1.0
    while lowest > energy * (1 + ENERGY_ROUNDING):
        share /= 2
        if share < SHORTEST:
            return start, True
        point = start.towards(end, share)
        lowest = point.energy(problem)
    return point, abs(energy - lowest) <= ENERGY_ROUNDING * abs(lowest)
