"""What a march carries from step to step."""

from __future__ import annotations

from dataclasses import dataclass

from fe_contact.bodies.memory import SurfaceMemory
from fe_contact.contact import ContactSolution
from fe_contact.march import Work


@dataclass(frozen=True)
class State:
    """Striker and surface at an instant: s, m, m/s, N s since touch."""

    time: float
    depth: float
    velocity: float
    impulse: float
    memory: SurfaceMemory


@dataclass(frozen=True)
class Step:
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
