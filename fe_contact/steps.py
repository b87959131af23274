"""What a march carries from step to step: named tuples, of which there are many and which are quick to make."""

from __future__ import annotations

from typing import Any, NamedTuple

from fe_contact.contact import ContactSolution
from fe_contact.march import Work


class State(NamedTuple):
    """Striker and body at an instant: s, m, m/s, N s since touch; ``memory`` is the body's own."""

    time: float
    depth: float
    velocity: float
    impulse: float
    memory: Any


class Step(NamedTuple):
    """A step taken, SI units: its length, the state after it, force and contact radius in it, and when that was.

    ``axis_response`` is the axis' displacement times modulus, ``scale`` the contact radius the mesh was scaled
    to, ``solution`` in units of the unit mesh.
    """

    length: float
    state: State
    force: float
    radius: float
    radius_time: float
    axis_response: float
    solution: ContactSolution
    scale: float
    work: Work
