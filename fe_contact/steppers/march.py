"""What goes into an impact and what comes out of it: frozen records."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

from fe_contact.assembly.forms import Array
from fe_contact.bodies.offer import Memory
from lumped.materials import Relaxation
from lumped.scene.scene import Scene


@dataclass(frozen=True)
class Strike:
    """Physics of an impact: profile height(r), m; mass, kg; velocity, m/s; gravity along the motion, m/s2;
    contact modulus E*(t); time at which to stop, s after touch; where it is not depth - height, overlap(arc, depth), m;
    and the length over which forces and modulus are totals in plane strain, m, else 1.

    A later one of several begins with a touch at a time, s since the first one, and a depth, m, on a body with a
    ``memory``, None: at rest.
    """

    height: Callable[[Array], Array]
    mass: float
    velocity: float
    gravity: float
    relaxation: Relaxation
    end_time: float
    overlap: Callable[[Array, float], Array] | None = None
    total: float = 1.0
    touched_at: float = 0.0
    depth: float = 0.0
    memory: Memory = None

    def again(self, flown: float, depth: float, velocity: float, memory: Memory = None) -> Strike:
        """The strike that begins with a touch, some time ``flown`` after this one, s, at a depth, m, and m/s."""
        return replace(
            self,
            velocity=velocity,
            depth=depth,
            memory=memory,
            touched_at=self.touched_at + flown,
            end_time=self.end_time - flown,
        )

    @classmethod
    def of(cls, scene: Scene) -> Strike:
        """The first touch of a scene; forces in plane strain are totals, so the modulus counts with the length."""
        target, profile = scene.target, scene.profile
        place, lead = target.length_of_place, target.lead
        bent = None if place == 1.0 else lambda arc, depth: target.overlap(profile, arc / place, depth)
        return cls(
            overlap=bent,
            height=lambda r: -target.overlap(profile, r / place, 0.0) / lead,
            mass=scene.reduced_mass,
            velocity=scene.velocity,
            gravity=scene.gravity,
            relaxation=scene.contact_modulus.scaled(scene.geometry.shape.total),
            end_time=scene.end_time,
            total=scene.geometry.shape.total,
        )


@dataclass(frozen=True)
class Snapshot:
    """Surface in one step: time, s; force, N; contact radius, m; radii and pressure at the quadrature points, m, Pa.

    In plane strain the pressure too is a total over the length, Pa m.
    """

    time: float
    force: float
    contact_radius: float
    radii: Array
    pressure: Array


class Work(NamedTuple):
    """Counted work: time steps, contact problems, Newton iterations."""

    steps: int = 0
    contact_problems: int = 0
    iterations: int = 0


@dataclass(frozen=True)
class March:
    """History of one impact with one set of settings.

    ``time``, ``depth``, ``impulse`` (n,) at the ends of the steps, the first row at touch, the last at
    separation or ``end_time``; ``first_force``, N, right at touch; ``radius_time``, ``radius`` (n,) of the contact;
    ``photograph`` makes a snapshot a step; ``energy`` J, each term computed on its own; ``end_spread`` s, how far
    the last predictions of the separation lie apart; ``memory`` of the body after the last step, at ``memory_time``, s.
    """

    time: Array
    depth: Array
    impulse: Array
    first_force: float
    radius_time: Array
    radius: Array
    separated: bool
    photograph: Callable[[], tuple[Snapshot, ...]]
    energy: dict[str, float]
    end_spread: float
    work: Work
    memory: Memory = None
    memory_time: float = 0.0

    @cached_property
    def snapshots(self) -> tuple[Snapshot, ...]:
        """The surface in every step, where it is known; read when first asked for: few impacts ever show it."""
        return self.photograph()
