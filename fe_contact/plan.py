"""Scene and tolerance -> settings and model ledger, without running anything.

The exact row of springs tells how large the contact becomes and how long it lasts; that places the mesh,
the memory and the time steps. Nothing of it enters a value or an error bar.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from fe_contact.bulk_scales import with_constant_nu
from fe_contact.numerics import RANGES, Numerics
from lumped.laws import mdr
from lumped.laws._hereditary_force import estimate
from lumped.model_ledger import Peak, model_ledger
from lumped.result import LedgerEntry
from lumped.scene import Scene
from lumped.targets import HalfSpace

DEFAULT_TOLERANCE = 1e-3
ELEMENTS = 4.0  # along the contact radius, at tolerance 1e-3 and 1e-4: see `fe-contact tradeoff`
SPRINGS = 32  # along the contact radius: scales within one per cent place everything well
FIXED_ELEMENTS = 2.0  # the same on a mesh that stays, four times refined where the contact may end
VISCOUS_ORDER = 0.18  # six elements instead of four at 1e-4
STEPS_AT_DEFAULT = 40
STEPS_ORDER = 0.176  # steps grow with tolerance to this power: 60 at 1e-4
SOONEST_PEAK = 1e-6  # share of the contact below which the time grid would lose its digits
EARLY_PEAK = 0.28  # a force that peaks before this share of the contact needs more steps in proportion
DEFAULTS: Mapping[str, Any] = {
    "order": 4,
    "penalty": 1000.0,
    "enforcement": "corrected",
    "scheme": "galerkin",
    "far_radius": 20.0,
}


@dataclass(frozen=True)
class Plan:
    """Settings chosen for a scene, those of them the user fixed, and what the model leaves out."""

    numerics: Numerics
    pinned: frozenset[str]
    ledger: tuple[LedgerEntry, ...]


def plan(scene: Scene, given: Mapping[str, Any]) -> Plan:
    """Choose what ``given`` (checked settings, see :func:`fe_contact.numerics.checked`) leaves open.

    Raises NotReached where even the coarse row of springs does not come to an end.
    """
    tolerance = float(given.get("tolerance", DEFAULT_TOLERANCE))
    scales = _scales(scene)
    contact_time = scales.duration or scene.end_time
    peak_share = min(max(scales.peak_time / contact_time, SOONEST_PEAK), 1.0)
    chosen = {
        **DEFAULTS,
        "tolerance": tolerance,
        "elements_per_contact": _elements(scene, tolerance),
        "steps": _steps(tolerance, peak_share),
        "contact_radius": scales.contact_radius,
        "contact_time": contact_time,
        "peak_share": peak_share,
    }
    peak = Peak(scales.peak_force, scales.peak_depth, scales.contact_radius, 2 * scales.peak_time)
    return Plan(Numerics(**{**chosen, **given}), frozenset(given) - {"tolerance"}, model_ledger(scene, peak))


def _scales(scene: Scene) -> mdr.ImpactScales:
    """By the row of springs, or where it has no answer by the target's load curve."""
    geometry = scene.geometry
    if isinstance(geometry.target, HalfSpace) and geometry.shape.fixed_radius is None and not geometry.shape.plane:
        return mdr.estimate(scene, SPRINGS)
    return estimate(scene if geometry.surface_remembers else with_constant_nu(scene))


def _elements(scene: Scene, tolerance: float) -> float:
    """Elements along the contact radius; a dashpot asks for more, since it differentiates the mesh's error."""
    order = VISCOUS_ORDER if scene.contact_modulus.viscosity > 0 else 0.0
    fewest = ELEMENTS if isinstance(scene.target, HalfSpace) else FIXED_ELEMENTS
    return fewest * max(1.0, math.pow(1e-4 / tolerance, 0.25), math.pow(DEFAULT_TOLERANCE / tolerance, order))


def _steps(tolerance: float, peak_share: float) -> int:
    """Time steps per contact, a multiple of four so that the budget can halve them twice."""
    early = max(1.0, EARLY_PEAK / peak_share)
    wanted = early * STEPS_AT_DEFAULT * (DEFAULT_TOLERANCE / tolerance) ** STEPS_ORDER
    lowest, highest = RANGES["steps"]
    return int(min(max(4 * math.ceil(wanted / 4), 2 * lowest), highest))


def refined(numerics: Numerics, cause: str) -> Numerics:
    """Settings with less of one cause of error."""
    if cause == "time_step":
        return numerics.varied(steps=2 * numerics.steps)
    if cause == "mesh":
        return numerics.varied(elements_per_contact=1.5 * numerics.elements_per_contact)
    if cause == "penalty":
        return numerics.varied(penalty=4 * numerics.penalty)
    return numerics.varied(far_radius=2 * numerics.far_radius)


SETTING = {
    "mesh": "elements_per_contact",
    "penalty": "penalty",
    "time_step": "steps",
    "far_field": "far_radius",
}
