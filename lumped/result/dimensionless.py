"""What an impact depends on without units, and its peak and times in units of an elastic impact of the same profile.

Two impacts with the same profile, base and groups have the same history in these units.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lumped.scene.geometry import contact_modulus
from lumped.schema import Table

if TYPE_CHECKING:
    from lumped.result.history import History
    from lumped.scene.indenter import Indenter
    from lumped.scene.scene import Scene


def groups(scene: Scene, values: Mapping[str, float | None], history: History) -> Table:
    """The groups by name, of the ``values`` of the quantities; empty without a geometry, None where one is undefined.

    E_i/E_inf of the contact moduli; tau/T, every relaxation time over the duration; nu; a/R with the largest contact
    radius; h/a, thickness over that; and, F0 and T0 the peak force and duration of the shape's elastic impact on the
    half-space with the relaxed modulus (a fluid's with the instantaneous one), F/F0, t/T0 at the peak, T/T0.
    """
    if not scene.has_geometry:
        return {}
    geometry, modulus = scene.geometry, scene.contact_modulus
    largest = float(history.contact_radius.max())
    duration = values["duration"]
    unit = geometry.shape.hertz_impact(modulus.relaxed or modulus.glassy, scene.reduced_mass, scene.velocity)
    return {
        "E_i/E_inf": _over(modulus.instantaneous, modulus.relaxed),
        "tau/T": [_over(tau, duration) for tau in modulus.times],
        "nu": geometry.material.nu,
        "a/R": _over(largest, geometry.shape.tip_radius),
        "h/a": _over(geometry.target.body_depth, largest),
        "F/F0": _over(values["peak_force"], unit.force),
        "t/T0": _over(values["peak_time"], unit.duration),
        "T/T0": _over(duration, unit.duration),
        "F0": unit.force,
        "T0": unit.duration,
    }


def groups_at_rest(indenter: Indenter, contact_radius: NDArray[np.float64]) -> Table:
    """Those of a slow indentation, which knows no time: E_i/E_inf, nu, a/R and h/a with the largest of its radii, m."""
    modulus = contact_modulus(indenter.shape, indenter.material, indenter.striker_material)
    largest = float(contact_radius.max())
    return {
        "E_i/E_inf": _over(modulus.instantaneous, modulus.relaxed),
        "nu": indenter.material.nu,
        "a/R": _over(largest, indenter.shape.tip_radius),
        "h/a": _over(indenter.target.body_depth, largest),
    }


def _over(value: float | None, unit: float | None) -> float | None:
    return value / unit if value is not None and unit else None
