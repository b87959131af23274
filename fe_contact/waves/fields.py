"""Displacement, velocity and stress of the half-space with waves at peak force: the march again, up to that instant."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fe_contact.assembly.forms import Array, isotropic
from fe_contact.dynamics import memory
from fe_contact.dynamics.march import march
from fe_contact.dynamics.state import BodyState
from fe_contact.fields import Fields, nodal_stress, subdivided, written
from fe_contact.settings import WaveNumerics
from fe_contact.waves.half_space_body import UnitBody, moving, unit_of
from fe_contact.waves.impact import choices_of
from fe_contact.waves.moving import Moving
from lumped.result.result import Result
from lumped.scene.scene import Scene


def write_fields(scene: Scene, result: Result, where: Path) -> Path:
    """Write ``fields.vtu``, see :mod:`fe_contact.fields`, of an impact that was solved; its path. Raises NotReached.

    Of several contacts the first is shown.
    """
    peak_time = result.contacts[0]["peak_time"] if result.contacts else result.quantities["peak_time"].value
    fields, velocity = fields_at(scene, WaveNumerics(**result.numerics), peak_time or 0.0)
    return written(fields, where, velocity)


def fields_at(scene: Scene, numerics: WaveNumerics, time: float) -> tuple[Fields, Array]:
    """The fields at a time, s, to the next step, and the velocity of the points (n, 2), m/s. Raises NotReached."""
    body, unit, a = moving(scene, numerics), unit_of(scene, numerics), numerics.contact_radius
    state = march(body.body, body.velocity, choices_of(scene, numerics), time, body.watch).final
    points = a * unit.basis.doflocs.T
    surface = points[:, 1] == 0.0
    pressure = np.where(surface, np.interp(points[:, 0], body.places, state.pressure, right=0.0), 0.0)
    held = state.signed_pressure > 0.0
    radius = float(body.places[held].max(initial=0.0))
    poisson = scene.geometry.material.nu
    law = isotropic(1 - poisson**2, poisson)  # of E* = 1
    found = Fields(
        time=state.time,
        depth=float(state.displacement[-1]),
        contact_radius=radius,
        points=points,
        triangles=subdivided(unit.basis),
        displacement=_everywhere(unit, state.displacement).reshape(-1, 2),
        stress=nodal_stress(unit.basis, _everywhere(unit, _stressed(body, state)) / a, law),
        pressure=pressure,
        contact=(surface & (points[:, 0] <= radius)).astype(np.int64),
    )
    return found, _everywhere(unit, state.velocity).reshape(-1, 2)


def _stressed(moving: Moving, state: BodyState) -> Array:
    """Modulus times displacement, of all that it remembers, (N,), N/m."""
    (part,), (branches,) = moving.body.parts, state.branches
    return memory.stressed(part, state.displacement, branches) + part.relaxation.viscosity * state.velocity


def _everywhere(unit: UnitBody, values: Array) -> Array:
    """Values of the matrices' degrees of freedom on all nodes, two a node; the striker's left out."""
    full = np.zeros(2 * unit.basis.N)
    full[unit.free] = values[:-1]
    return full
