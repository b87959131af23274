"""The layer with waves: its base sends them back under the striker, its sides let them go."""

from __future__ import annotations

import math

from fe_contact.assembly.forms import check_compressible
from fe_contact.budget.plan import Plan
from fe_contact.budget.scales import scales
from fe_contact.progress import Progress
from fe_contact.settings import RANGES, Given, WaveNumerics
from fe_contact.waves.cost import Cost
from fe_contact.waves.layer_body import moving
from fe_contact.waves.plan import DEFAULTS, SPREAD, TRAVEL, contact_time, placed
from fe_contact.waves.refining import Waves, cost_of
from fe_contact.waves.refusals import too_fast
from fe_contact.waves.targets.base import WaveTarget
from lumped.errors import BadInput, Fault
from lumped.laws.mdr import ImpactScales
from lumped.scene.scene import Scene
from lumped.targets.layer import Layer

SPARE = 1.2  # a resonance may press the striker deeper than statics
# Width beyond the contact in thicknesses: at rest nothing is left of a load so far away, and in a contact of many
# echoes no wave fast enough to come back is left either.
NEAREST, FARTHEST = 8.0, 20.0
LEAST = 4.0  # contact radii, of which half still holds the contact
ROUGH: Given = {
    "tolerance": 1e-2,
    "elements_per_contact": 2.0,
    "penalty": 100.0,
    "steps": 8,
    "far_radius": 20.0,
    "contact_radius": 1.0,
    "contact_time": 1.0,
    "peak_share": 0.5,
}


def plan(scene: Scene, given: Given) -> Plan:
    """Choose what ``given`` (checked settings) leaves open; the impact without inertia places mesh and steps.

    Raises NotReached where even that does not come to an end, BadInput for a contact beyond its load curve.
    """
    check(scene)
    check_compressible(scene)
    size = scales(scene, WaveNumerics(**DEFAULTS, **ROUGH))
    return placed(scene, given, size, _far_radius(scene, size), SPARE, _stiffness(scene, size))


def cost(scene: Scene, numerics: WaveNumerics) -> Cost:
    """Of an error budget with these settings. Raises BodyTooFine."""
    return cost_of(scene, numerics, moving)


def way(scene: Scene, chosen: Plan, progress: Progress) -> Waves:
    """Marched with waves, refined by what is missing."""
    return Waves.of(scene, chosen, moving, progress)


def check(scene: Scene) -> None:
    """Raise BadInput for several impacts, a striker with a rim, and one too fast."""
    scene.check_single("fe, where the layer rings on between contacts,")
    shape, faults = scene.geometry.shape, too_fast(scene)
    if shape.fixed_radius is not None:
        reason = f"{shape.name}: no waves under its rim in this version; accepted with model.inertia: a round profile"
        faults.append(Fault(scene.source, "striker.shape", reason))
    if faults:
        raise BadInput(faults)


def _stiffness(scene: Scene, size: ImpactScales) -> float:
    """Of the layer under the largest contact, over that of a half-space; at least one."""
    shape, a = scene.profile, size.contact_radius
    curve = scene.target.load_curve(shape, scene.geometry.material.nu)
    slope = float(curve.force_and_slope(size.peak_depth)[1])
    area = 2.0 * a if shape.plane else math.pi * a**2
    return max(0.5 * math.pi * slope * a / area, 1.0)


def _far_radius(scene: Scene, size: ImpactScales) -> float:
    """In contact radii, as far as pressure waves of the first answer, or a dashpot's spreading, go and come back."""
    material, duration, target = scene.geometry.material, contact_time(scene, size), scene.target
    assert isinstance(target, Layer)
    confined, density = material.confined_modulus(), material.density or 1.0
    travel = TRAVEL * math.sqrt(confined.glassy / density) * duration
    spread = SPREAD * math.sqrt(confined.viscosity * duration / density)
    width = min(max(travel, spread, NEAREST * target.thickness), FARTHEST * target.thickness)
    return min(max(1.0 + width / (SPARE * size.contact_radius), LEAST), RANGES["far_radius"][1])


MEMBER = WaveTarget(check=check, plan=plan, cost=cost, way=way)
