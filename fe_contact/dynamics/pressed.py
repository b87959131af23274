"""The contact problem of one step: what would overlap without new pressure, and how the body yields to it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fe_contact.assembly.forms import Array, Indices
from fe_contact.assembly.pressed_surface import PressedSurface
from fe_contact.contact.enforcement.base import Enforcement
from fe_contact.contact.problem import ContactProblem, Touching
from fe_contact.dynamics.body import Pressing
from fe_contact.errors import ContactNotSettled


@dataclass(frozen=True, eq=False)
class Enforced:
    """A member of :mod:`fe_contact.contact.enforcement`, or like one, and its penalty, Pa/m."""

    member: Enforcement
    penalty: float

    @property
    def is_law(self) -> bool:
        """Whether pressure follows from the overlap alone, wherever that comes from."""
        return self.member.law is not None

    def known(self, overlap: Array) -> Found:
        """Pressure of an overlap (q,) that no pressure changes any more, of a member that is a law."""
        assert self.member.law is not None
        return Found(self.member.law(overlap, self.penalty), 0)

    def found(self, surface: PressedSurface, overlap: Array, touching: Touching, time: float) -> Found:
        """Pressure that leaves of a free overlap (q,) what the member allows; raises ContactNotSettled."""
        if not (touching.any() or (overlap > 0.0).any()):
            return Found(self.penalty * overlap, 0)
        problem = ContactProblem(surface, overlap, self.penalty)
        solution = self.member.enforce(problem, touching)
        if not solution.converged:
            raise ContactNotSettled(time)
        return Found(solution.signed_pressure, solution.iterations)


class Found(NamedTuple):
    """Signed pressure (q,), negative where open, and Newton iterations."""

    signed_pressure: Array
    iterations: int

    @property
    def pressure(self) -> Array:
        """Contact pressure (q,), >= 0."""
        return np.maximum(self.signed_pressure, 0.0)


def surface_of(compliance: Array, pressing: Pressing, nodes: Indices | slice = slice(None)) -> PressedSurface:
    """What contact knows of a body whose surface ``nodes`` (m,) move by ``compliance`` (m, m) per force."""
    symmetric = (compliance + compliance.T) / 2
    stiffness = np.linalg.inv(symmetric)
    trace = pressing.trace[:, nodes]
    return PressedSurface((stiffness + stiffness.T) / 2, trace, pressing.weights, carriers=pressing.carriers)
