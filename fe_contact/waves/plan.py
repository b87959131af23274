"""Scene and tolerance -> settings of an impact on the half-space with waves, and model ledger; nothing is run.

The exact row of springs, which has no inertia, places mesh and time steps. Nothing of it enters a value or a bar.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from fe_contact.assembly.absorbing import wave_speeds
from fe_contact.assembly.forms import check_compressible
from fe_contact.budget.plan import SOONEST_PEAK, Plan
from fe_contact.settings import RANGES, Given, WaveNumerics
from lumped.laws import mdr
from lumped.laws.mdr import ImpactScales
from lumped.materials import Relaxation
from lumped.result.model_ledger import Peak, model_ledger
from lumped.scene.scene import Scene

DEFAULT_TOLERANCE = 3e-3  # of a peak force; what chatter at the contact's edge leaves is about a third
SPRINGS = 32  # along the contact radius: scales within one per cent place everything well
ELEMENTS = 9.0  # along every contact radius
FINER = 2.0  # times as many at the surface where dashpots carry much: pressure is infinite at an edge that advances
PENALTY = 120.0
STIFF = 16.0  # times as much there
MUCH = 0.5  # of the stiffness until the force peaks: less than this of dashpots asks for less than all of both
STEPS = 320  # along a contact, shorter ones about an early peak
TRAVEL = 0.5  # of the contact time: an echo from the far radius returns after the contact
LEAST_RESTITUTION = 0.1  # a striker that comes back slower hardly comes back again
NEAREST = 20.0  # contact radii: the far springs' own need
SPREAD = 3.0  # lengths over which a dashpot in parallel, which has no wave speed, spreads a motion in a contact
DEFAULTS: Given = {
    "order": 3,
    "enforcement": "corrected",
    "scheme": "generalised_alpha",
    "rho": 0.5,
    "mass": "consistent",
}


def plan(scene: Scene, given: Given) -> Plan:
    """Choose what ``given`` (checked settings) leaves open.

    Raises NotReached where even the row of springs does not come to an end.
    """
    check_compressible(scene)
    scales = mdr.estimate(scene, SPRINGS)
    longest = _slowest(scene, scales.restitution) * contact_time(scene, scales)
    return placed(scene, given, scales, _far_radius(scene, scales.contact_radius, longest))


def contact_time(scene: Scene, scales: ImpactScales) -> float:
    """Of the estimated impact, s, or all that there is time for."""
    return scales.duration or scene.end_time


def placed(
    scene: Scene,
    given: Given,
    scales: ImpactScales,
    far_radius: float,
    wide: float = 1.0,
    stiff: float = 1.0,
) -> Plan:
    """What ``given`` leaves open for an impact of these scales, on a mesh that ends at ``far_radius``, contact radii.

    ``wide``: the contact radius to be ready for over the estimated one; ``stiff``: the body over a half-space under it.
    """
    tolerance, duration = float(given.get("tolerance", DEFAULT_TOLERANCE)), contact_time(scene, scales)
    finer = max(1.0, DEFAULT_TOLERANCE / tolerance)
    peak_share = min(max(scales.peak_time / duration, SOONEST_PEAK), 1.0)
    viscous = min(viscous_share(scene.contact_modulus, peak_share * duration) / MUCH, 1.0)
    chosen = {
        **DEFAULTS,
        "tolerance": tolerance,
        "elements_per_contact": ELEMENTS * math.sqrt(finer),
        "finer": 1.0 + (FINER - 1.0) * viscous,
        "penalty": PENALTY * stiff * (1.0 + (STIFF - 1.0) * viscous),
        "steps": 4 * math.ceil(STEPS * math.sqrt(finer) / 4),
        "far_radius": far_radius,
        "contact_radius": wide * scales.contact_radius,
        "contact_time": duration,
        "peak_share": peak_share,
    }
    peak = Peak(scales.peak_force, scales.peak_depth, scales.contact_radius, 2 * scales.peak_time)
    return Plan(WaveNumerics(**{**chosen, **given}), frozenset(given) - {"tolerance"}, model_ledger(scene, peak))


def viscous_share(modulus: Relaxation, time: float) -> float:
    """How much of the stiffness against a steady advance for some time, s, is that of dashpots.

    A branch that has long relaxed is one of them, of viscosity modulus x time; at once it is a spring.
    """
    ratios = time / np.asarray(modulus.times)
    held = -np.expm1(-ratios) / ratios  # of a branch's modulus, at the end
    flowing = modulus.viscosity / time + float(np.dot(modulus.moduli, held * (1.0 - held)))
    return flowing / (modulus.equilibrium + modulus.viscosity / time + float(np.dot(modulus.moduli, held)))


def _slowest(scene: Scene, restitution: float | None) -> float:
    """How much longer the last contact lasts than the first: as an elastic one does, with its speed to the -1/5."""
    elastic = partial(scene.profile.hertz_impact, 1.0, 1.0)
    slower = max(restitution or 1.0, LEAST_RESTITUTION) ** (scene.motion.impacts - 1)
    return elastic(slower).duration / elastic(1.0).duration


def _far_radius(scene: Scene, contact_radius: float, duration: float) -> float:
    """In contact radii: so far that pressure waves of the stiffest answer return too late, or viscosity has faded."""
    material = scene.geometry.material
    modulus = material.contact_modulus()  # the target's own, whatever strikes it
    density = material.density or 1.0
    fastest = wave_speeds(material.nu)[0] * math.sqrt(modulus.glassy / density)
    travel = max(TRAVEL * fastest * duration, SPREAD * math.sqrt(modulus.viscosity * duration / density))
    return min(max(travel / contact_radius, NEAREST), RANGES["far_radius"][1])
