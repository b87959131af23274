"""A rigid profile pressed into a body at rest: the contact problem at one depth, elastic with unit modulus."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType
from typing import Protocol

import numpy as np

from fe_contact.bodies.scaled_surface import ScaledSurface
from fe_contact.contact import ContactSolution
from fe_contact.errors import IndentationNotSettled
from fe_contact.forms import Array
from fe_contact.numerics import ENFORCEMENTS, Numerics
from lumped.members import get

EDGE_WINDOW = 0.02  # the contact edge may lie this far from the node where the mesh is finest
RESCALINGS = 60
BEYOND = 1e3  # height, in contact radii, given to radii past the striker's rim


class Profile(Protocol):
    """Height of a striker over the radius."""

    def height(self, r: Array) -> Array: ...


@dataclass(frozen=True)
class Pressed:
    """Force over modulus, m^2, and contact radius, m, at one depth; contact problems and Newton iterations spent."""

    force: float
    contact_radius: float
    problems: int
    iterations: int


def pressed(surface: ScaledSurface, profile: Profile, depth: float, guess: float, numerics: Numerics) -> Pressed:
    """Press to a depth, m, the mesh scaled until the contact edge lies in its finest elements.

    ``guess``: a contact radius to begin with, m. Raises IndentationNotSettled.
    """
    enforcement: ModuleType = get(ENFORCEMENTS, numerics.enforcement)
    points, scale, iterations = surface.operator.points, guess, 0
    for attempt in range(1, RESCALINGS + 1):
        height = np.minimum(profile.height(scale * points), BEYOND * scale)
        solution: ContactSolution = enforcement.enforce(
            surface.problem(depth - height, numerics.penalty, 0.0), points < 1.0
        )
        iterations += solution.iterations
        if not solution.converged:
            break
        edge = solution.edge(points)
        if abs(edge - 1.0) <= EDGE_WINDOW:
            force = scale * float(surface.operator.weights @ solution.pressure)
            return Pressed(force, scale * edge, attempt * enforcement.SOLVES, iterations)
        scale *= min(max(edge, 0.3), points[-1])
    raise IndentationNotSettled(depth)
