"""Scene and tolerance -> settings and model ledger, without running anything.

An estimate tells how large the contact becomes and how long it lasts; that places the mesh, the memory and the time
steps. Nothing of it enters a value or an error bar. It comes from the exact row of springs, from the target's exact
load curve, or, where there is none, from one that a coarse mesh answers at a few depths.

A body of constant bulk modulus has the scales of one of constant Poisson's ratio that is as stiff at once and in the
end (:func:`with_constant_nu`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from fe_contact.assembly.forms import check_compressible
from fe_contact.bodies.pressing import Still
from fe_contact.settings import DEFAULT_TOLERANCE, RANGES, Given, Numerics, check_kind, tolerance_of
from fe_contact.steppers.flat_end import FlatEnd
from fe_contact.targets.base import TARGETS
from lumped.errors import BadInput, NotReached
from lumped.laws import mdr
from lumped.load_curves.base import LoadCurve
from lumped.load_curves.fixed_area import Column
from lumped.load_curves.sampled import SampledCurve
from lumped.materials import Material, Relaxation
from lumped.result.model_ledger import Ledger, Peak, pulse_lasts
from lumped.result.result import LedgerEntry
from lumped.scene.geometry import Geometry, stiffest_impact
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Answered, Scene
from lumped.targets import HalfSpace

SPRINGS = 32  # along the contact radius: scales within one per cent place everything well
# Work: of the mesh that tells how large a contact will be; order of its elements.
COARSE = {"elements_per_contact": 2.0, "order": 2}
# Contact radii on a round body, over its radius, at which the coarse mesh is asked.
WIDTHS = tuple(float(share) for share in np.geomspace(5e-3, 0.6, 9))
ELEMENTS = 4.0  # along the contact radius, at tolerance 1e-4: see `fe-contact tradeoff`
LOOSER = math.log10(4.0 / 3.2)  # three and a fifth of them at 1e-3 where the mesh follows the contact
FIXED_ELEMENTS = 2.0  # the same on a mesh that stays, four times refined where the contact may end
FINER = 1.2  # elements and steps on such a mesh where a round contact meets a body that relaxes, over those elsewhere
SPARE = 1.2  # such a mesh is fine beyond the largest contact, where the gap tells how wide that is
BAND = 1.125  # ratio of the radii that such meshes are made for: impacts whose contacts are about as wide share them
RIM_PENALTY = 16.0  # penalty under a rim over the usual: the pressure is infinite there
VISCOUS_ORDER = 0.18  # six elements instead of four at 1e-4
STEPS_AT_DEFAULT = 40  # and no fewer at any tolerance: halved twice, they still tell something
STEPS_ORDER = 0.176  # steps grow with tolerance to this power: 60 at 1e-4
FLAT_STEPS = 4  # as many under a flat end: its area presses at once, whatever relaxes fast, and a step is one sum
FLAT_ORDER = 2  # with which bars fall there, so that looser tolerances take fewer
AT_TOUCH = 1e-12  # share of the contact before which a peak is the touch itself, but for rounding
SOONEST_PEAK = 1e-6  # share of the contact below which the time grid would lose its digits
EARLY_PEAK = 0.28  # a force that peaks before this share of the contact needs more steps in proportion
DEFAULTS: Given = {
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
    ledger: Sequence[LedgerEntry]


def plan(scene: Scene, given: Given) -> Plan:
    """Choose what ``given`` (checked settings, see :func:`fe_contact.settings.checked`) leaves open, without waves.

    Raises NotReached where even a coarse estimate does not come to an end.
    """
    check_kind(given, False, scene.source)
    tolerance = tolerance_of(given)
    chosen = _settings(scene, tolerance)
    size = scales(scene, chosen)
    # gravity holds what does not separate, and swings it; a dashpot may answer most at the touch
    held = max(2.0 * size.peak_time, scene.elastic_contact_time)
    contact_time = size.duration or min(held if scene.gravity > 0.0 else size.end, scene.end_time)
    peak_share = share_of_peak(size.peak_time, contact_time)
    placed = chosen.varied(
        steps=_steps(tolerance, peak_share, _flat_steps(tolerance) if _flat(scene) else _finer(scene)),
        contact_radius=_meshed_radius(scene, SPARE * size.contact_radius) if _stays(scene) else size.contact_radius,
        contact_time=contact_time,
        peak_share=peak_share,
    )
    lasts = pulse_lasts(size.duration, size.peak_time, scene.motion.end_time or contact_time)
    peak = Peak(size.peak_force, size.peak_depth, size.contact_radius, lasts)
    return Plan(placed.varied(**given), frozenset(given) - {"tolerance"}, Ledger(scene, peak, scene.model))


def share_of_peak(peak_time: float, contact_time: float) -> float:
    """Time of the force's peak over that of the contact; one that falls from the touch on has no rise to resolve."""
    share = peak_time / contact_time
    return min(max(share, SOONEST_PEAK), 1.0) if share > AT_TOUCH else 0.5


def crowded(peak_share: float) -> float:
    """Steps that a force takes which peaks so early, over those of most scenes."""
    return max(1.0, EARLY_PEAK / peak_share)


def _settings(scene: Scene, tolerance: float) -> Numerics:
    """What does not depend on how large the impact is."""
    chosen = {
        **DEFAULTS,
        "tolerance": tolerance,
        "elements_per_contact": _elements(scene, tolerance),
        "penalty": DEFAULTS["penalty"] * (RIM_PENALTY if _flat(scene) else 1.0),
        "steps": RANGES["steps"][0],
    }
    return Numerics(**chosen, contact_radius=1.0, contact_time=1.0, peak_share=0.5)


def _elements(scene: Scene, tolerance: float) -> float:
    """Elements along the contact radius; a dashpot asks for more, since it differentiates the mesh's error."""
    order = VISCOUS_ORDER if scene.contact_modulus.viscosity > 0 else 0.0
    fewest = FIXED_ELEMENTS * _finer(scene) if _stays(scene) else ELEMENTS
    if not _stays(scene) and not _flat(scene):
        fewest *= math.pow(min(max(1e-4 / tolerance, 0.1), 1.0), LOOSER)
    finer = max(1.0, math.pow(1e-4 / tolerance, 0.25), math.pow(DEFAULT_TOLERANCE / tolerance, order))
    return round(fewest * finer, 6)


def _stays(scene: Scene) -> bool:
    """Whether the mesh stays and the contact may end anywhere in it."""
    return scene.geometry.target.has_length and not _flat(scene)


def _finer(scene: Scene) -> float:
    """Elements and steps over those of most scenes."""
    return FINER if _stays(scene) and not scene.profile.plane and not scene.contact_modulus.is_elastic else 1.0


def _meshed_radius(scene: Scene, radius: float) -> float:
    """The one next to a radius, m, of those that meshes of the scene's bodies are made for."""
    target, shape = scene.geometry.target, scene.geometry.shape
    length = target.body_depth or target.round_radius(shape)
    return length * BAND ** round(math.log(radius / length, BAND))


def _flat(scene: Scene) -> bool:
    """Whether a flat end presses the same area from the first touch to the last."""
    return scene.geometry.target.fixed_radius(scene.geometry.shape) is not None


def _steps(tolerance: float, peak_share: float, finer: float) -> int:
    """Time steps per contact, so many times `finer`, a multiple of four so that the budget can halve them twice."""
    wanted = crowded(peak_share) * STEPS_AT_DEFAULT * max(DEFAULT_TOLERANCE / tolerance, 1.0) ** STEPS_ORDER
    return int(min(4 * math.ceil(finer * math.ceil(wanted / 4)), RANGES["steps"][1]))


def _flat_steps(tolerance: float) -> float:
    """Steps under a flat end over those of most scenes."""
    return max(FLAT_STEPS * math.pow(min(DEFAULT_TOLERANCE / tolerance, 1.0), 1.0 / FLAT_ORDER), 1.0)


def expected(scene: Scene) -> mdr.ImpactScales:
    """Scales of a scene that every plan begins with. Raises NotReached, BadInput."""
    return scales(scene, _settings(scene, DEFAULT_TOLERANCE))


def scales(scene: Scene, numerics: Numerics) -> mdr.ImpactScales:
    """Of a scene; ``numerics`` but for the settings that are coarse. Raises NotReached, BadInput."""
    geometry = scene.geometry
    if isinstance(geometry.target, HalfSpace) and not geometry.shape.flat_radius and not geometry.shape.plane:
        with suppress(NotReached):  # where weight hardly lets go, the springs at the edge may not leave
            return mdr.estimate(scene, SPRINGS)
    from lumped.laws import correspondence, ting  # late: most bodies are half-spaces

    coarse, curve = numerics.varied(**COARSE), has_curve(scene)
    if not (curve and geometry.surface_remembers):
        check_compressible(scene)
    if not geometry.surface_remembers:
        scene = with_constant_nu(scene, partial(_stiffness, scene, coarse))
    if not curve:
        scene = Answered.by(scene, _answer(scene, coarse))
    grows_once = scene.gravity == 0.0 and not _flat(scene)
    return correspondence.estimate(scene, ting.solve if grows_once else None)


def _stiffness(scene: Scene, coarse: Numerics, elastic: Material) -> float:
    """Of an elastic target, in any unit; a round body counts as the half-space that it is near its contact."""
    geometry, modulus = replace(scene.geometry, material=elastic), half_space_stiffness(elastic)
    fixed = geometry.target.fixed_radius(geometry.shape)
    if has_curve(scene):
        stiffest = stiffest_impact(geometry.shape, scene.contact_modulus, scene.reduced_mass, scene.velocity)
        return modulus * float(geometry.target.load_curve(scene.profile, elastic.nu).force(stiffest.depth))
    return modulus if fixed is None else modulus * _flat_end(geometry, fixed, coarse).stiffness


def has_curve(scene: Scene) -> bool:
    """Whether the target's load curve is known in closed form."""
    try:
        scene.geometry.target.load_curve(scene.profile, scene.geometry.material.nu)
    except BadInput:
        return False
    return True


def _answer(scene: Scene, numerics: Numerics) -> LoadCurve:
    """By finite elements with these settings. Raises NotReached."""
    geometry = scene.geometry
    fixed = geometry.target.fixed_radius(geometry.shape)
    if fixed is not None:
        return Column(fixed, math.pi * fixed**2 / _flat_end(geometry, fixed, numerics).stiffness)
    elastic = geometry.springs
    indenter = Indenter(scene.profile, elastic.material, geometry.target, elastic.striker_material)
    radii = np.array(WIDTHS) * geometry.target.round_radius(geometry.shape)
    depths = -geometry.target.overlap(indenter.profile, radii, 0.0) / geometry.target.lead
    still: Still = TARGETS.get(geometry.target.name).still(indenter, radii, numerics)
    pressed = [still.press(float(depth), float(radius)) for depth, radius in zip(depths, radii, strict=True)]
    columns = zip(*((one.force, one.contact_radius) for one in pressed), strict=True)
    forces, widths = (tuple(float(value) for value in column) for column in columns)
    return SampledCurve(tuple(float(depth) for depth in depths), forces, widths)


def with_constant_nu(scene: Scene, stiffness: Callable[[Material], float]) -> Scene:
    """As stiff as the scene at once and, if it is a solid, in the end.

    ``stiffness`` of the target, made of an elastic material, N or any unit; a striker that relaxes counts as the
    half-space that it is near its contact.
    """
    striker = scene.striker_material
    return replace(
        scene,
        material=_alike(scene.geometry.material, stiffness),
        striker_material=None if striker is None else _alike(striker, half_space_stiffness),
    )


def half_space_stiffness(elastic: Material) -> float:
    """Contact modulus of an elastic material, Pa."""
    return elastic.contact_modulus().glassy


def _alike(material: Material, stiffness: Callable[[Material], float]) -> Material:
    """What lies between the stiffness at once and in the end is the network's, and the viscosity counts as a spring."""
    if material.constant == "poisson":
        return material
    sudden = material.elastic(instant=True)
    slow = material.elastic(instant=False) if material.young.relaxed > 0.0 else None
    nu = sudden.nu if slow is None else slow.nu
    young = material.young
    springs = young.glassy - young.relaxed
    wanted = stiffness(sudden) / stiffness(Material(Relaxation(1.0), nu))
    share = (wanted - young.relaxed) / springs if springs > 0.0 else 1.0
    network = Relaxation(
        young.equilibrium, tuple(share * modulus for modulus in young.moduli), young.times, share * young.viscosity
    )
    return replace(material, young=network, nu=nu, constant="poisson", bulk_modulus=None)


def _flat_end(geometry: Geometry, radius: float, numerics: Numerics) -> FlatEnd:
    return FlatEnd.of(geometry, radius, numerics, TARGETS.get(geometry.target.name).still)
