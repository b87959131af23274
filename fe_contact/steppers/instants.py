"""The contact pressure at instants of a march on a mesh that follows the contact, from the surface's shape and memory.

A step knows its mean pressure alone, with a kink wherever the edge stood at the end of an earlier step. At an instant
the surface within the contact is the striker's, its memory is known, and nothing presses outside. With the mesh scaled
to the contact radius a, so that its finest node is the edge, compliance C and mass M of the nodes up to there,

    pressure = M^-1 C^-1 w / a ,    w = E_inf u + sum_k E_k z_k + viscosity du/dt .

In the march a surface moves on a straight line within a step. Where the contact arrives in the middle of one, the
gap closes like the power 3/2 of the time left. No force notices, but the branches z_k are left with a kink at every
former edge: here they get what the straight line missed.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import SurfaceOperator
from fe_contact.bodies.memory import interpolate, step_law
from fe_contact.bodies.offer import Meshed
from fe_contact.bodies.pressing import BEYOND
from fe_contact.schemes.base import MemoryScheme
from fe_contact.steppers.march import Snapshot, Strike
from fe_contact.steppers.steps import State, Step

CLOSING = 1.5  # power of the time left with which the gap closes before an edge
EDGE = 1.0 - 1e-9  # of the unit mesh, safe from rounding
GAUSS = np.polynomial.legendre.leggauss(8)
SHARES, WEIGHTS = (GAUSS[0] + 1) / 2, GAUSS[1] / 2  # of a step


class SteppedBy(Protocol):
    """What took the steps: its memory's ``radii`` and the profile's ``heights`` there, m, each (r,)."""

    strike: Strike
    scheme: MemoryScheme
    radii: Array
    heights: Array

    @property
    def surface(self) -> Meshed: ...

    def touch(self) -> State:
        """The state at first touch."""


def read(stepper: SteppedBy, steps: Sequence[Step]) -> tuple[Snapshot, ...]:
    """One snapshot a step, when its contact radius was: pressure (q,), Pa, at the mesh's points, zero outside."""
    operator = stepper.surface.operator
    zone = int(operator.nodes.searchsorted(EDGE)) + 1
    radii = np.array([step.radius for step in steps])
    # what pulls at the last points is the error of the radius: a contact never does
    unit = np.maximum(_pressures(operator, _stresses(stepper, steps, operator.nodes[:zone, None] * radii)), 0.0)
    forces = radii * (operator.weights @ unit)
    return tuple(
        Snapshot(step.radius_time, float(force), step.radius, step.radius * operator.points, pressure)
        for step, force, pressure in zip(steps, forces, (unit / radii).T, strict=True)
    )


def _pressures(operator: SurfaceOperator, stresses: Array) -> Array:
    """Unit-mesh pressures at the points, (q, s), that hold displacements times modulus, (m, s), of the contact's nodes.

    Exactly the nodal forces' moments; none beyond the edge.
    """
    zone = len(stresses)
    inside = int(operator.points.searchsorted(EDGE))
    trace, weights = operator.trace[:inside, :zone], operator.weights[:inside, None]
    forces = np.linalg.solve(operator.response[:zone, :zone], stresses)
    found = np.zeros((len(operator.points), stresses.shape[1]))
    found[:inside] = trace @ np.linalg.solve(trace.T @ (weights * trace), forces)
    return found


def _stresses(stepper: SteppedBy, steps: Sequence[Step], places: Array) -> Array:
    """w at places (m, s), m, one column a step; Pa m."""
    times = np.array(stepper.strike.relaxation.times)
    missed = np.zeros((len(times), len(stepper.radii)))
    found = np.empty_like(places)
    before, edge, read_at = stepper.touch(), 0.0, 0.0
    for number, step in enumerate(steps):
        missed *= np.exp(-(step.radius_time - read_at) / times)[:, None]
        if step.radius > edge:
            missed += _missed(stepper, before, step, edge)
        found[:, number] = _stress(stepper, before, step, missed, places[:, number])
        before, edge, read_at = step.state, step.radius, step.radius_time
    return found


def _stress(stepper: SteppedBy, before: State, step: Step, missed: Array, places: Array) -> Array:
    """w at places (m,), m, when the contact radius was that of a step; ``missed`` (k, r) goes to the branches."""
    relaxation, after = stepper.strike.relaxation, step.state
    share = (step.radius_time - before.time) / step.length
    depth = before.depth + share * (after.depth - before.depth)
    velocity = before.velocity + share * (after.velocity - before.velocity)
    strain = before.memory.strain + share * (after.memory.strain - before.memory.strain)
    law = step_law(relaxation, stepper.scheme, share * step.length)
    branches = before.memory.advanced(law, strain).branches[:, 0] + missed
    now = relaxation.equilibrium * (depth - stepper.strike.height(places)) + relaxation.viscosity * velocity
    return np.asarray(now + interpolate(np.asarray(relaxation.moduli) @ branches, stepper.radii[-1], places))


def _missed(stepper: SteppedBy, before: State, step: Step, edge: float) -> Array:
    """What the branches (k, r) miss, m, of a step in which the contact grew from ``edge``, m.

    Of a detour from the straight line, dz/dt = du/dt - z/tau leaves -1/tau times its faded integral.
    """
    after, ratios = step.state, step.length / np.array(stepper.strike.relaxation.times)
    beside = slice(int(stepper.radii.searchsorted(edge, "right")), None)
    radii = stepper.radii[beside]
    height = np.minimum(stepper.heights[beside], BEYOND * stepper.radii[-1])  # a profile may end
    wide = np.maximum(before.memory.strain[0, beside] - (before.depth - height), np.finfo(float).tiny)
    narrow = np.clip(after.memory.strain[0, beside] - (after.depth - height), 0.0, EDGE * wide)
    reached = (radii**2 - edge**2) / (step.radius**2 - edge**2)
    arrival = np.where(radii < step.radius, reached, 1.0 / (1.0 - (narrow / wide) ** (1 / CLOSING)))
    left = np.maximum(1.0 - SHARES[:, None] / arrival, 0.0)
    detour = wide * left**CLOSING - (wide + SHARES[:, None] * (narrow - wide))
    missed = np.zeros((len(ratios), len(stepper.radii)))
    missed[:, beside] = -ratios[:, None] * ((WEIGHTS * np.exp(-np.outer(ratios, 1 - SHARES))) @ detour)
    return missed
