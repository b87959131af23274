"""The contact pressure as the body feels it, without what its shape functions cannot see.

The march keeps pressure at quadrature points, where the surface's memory leaves a roughness of some per cent
that has no moment against any shape function: force and displacement do not feel it. Projected onto the
surface's own shape functions the pressure is smooth, and its integral unchanged. Where the mesh follows the contact
it is read otherwise, see :mod:`fe_contact.steppers.instants`, and has no such roughness.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import SurfaceOperator
from fe_contact.budget.certify import Certified
from fe_contact.steppers.march import Snapshot


@dataclass(frozen=True, eq=False)
class Pressure:
    """Pressure (n,), Pa, at radii (n,), m, of the surface in one step; time, s; contact radius, m."""

    time: float
    contact_radius: float
    radii: Array
    values: Array

    def at(self, radii: Array) -> Array:
        """Pressure at other radii, linear in between, zero beyond the contact."""
        return np.where(radii <= self.contact_radius, np.interp(radii, self.radii, self.values), 0.0)


def felt(certified: Certified, step: int) -> Pressure:
    """Pressure in a step of the finest march."""
    snapshot = certified.march.snapshots[step]
    radii, values = certified.surface.felt(snapshot)
    return Pressure(snapshot.time, snapshot.contact_radius, radii, values / certified.curve.strike.total)


def scale(operator: SurfaceOperator, snapshot: Snapshot) -> float:
    """Length of the unit mesh in a step, m."""
    return float(snapshot.radii[0] / operator.points[0])


def peak_step(certified: Certified) -> int:
    """Index of the step of largest force."""
    return int(np.argmax([snapshot.force for snapshot in certified.march.snapshots]))


def nearest_step(certified: Certified, time: float) -> int:
    """Index of the step whose pressure lies nearest to a time, s."""
    return int(np.argmin([abs(s.time - time) for s in certified.march.snapshots]))
