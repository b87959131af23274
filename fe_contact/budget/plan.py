"""Scene and tolerance -> settings and model ledger, without running anything.

An estimate tells how large the contact becomes and how long it lasts; that places the mesh, the memory and the time
steps. Nothing of it enters a value or an error bar.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from fe_contact.budget.scales import scales
from fe_contact.errors import says_which_key
from fe_contact.settings import RANGES, Given, Numerics, check_kind
from lumped.result.model_ledger import Peak, model_ledger
from lumped.result.result import LedgerEntry
from lumped.scene.scene import Scene

DEFAULT_TOLERANCE = 1e-3  # default: relative, of every certified quantity
ELEMENTS = 4.0  # along the contact radius, at tolerance 1e-4: see `fe-contact tradeoff`
LOOSER = math.log10(4.0 / 3.2)  # three and a fifth of them at 1e-3 where the mesh follows the contact
FIXED_ELEMENTS = 2.0  # the same on a mesh that stays, four times refined where the contact may end
SPARE = 1.2  # such a mesh is fine beyond the largest contact, where the gap tells how wide that is
RIM_PENALTY = 16.0  # penalty under a rim over the usual: the pressure is infinite there
VISCOUS_ORDER = 0.18  # six elements instead of four at 1e-4
STEPS_AT_DEFAULT = 40  # and no fewer at any tolerance: halved twice, they still tell something
STEPS_ORDER = 0.176  # steps grow with tolerance to this power: 60 at 1e-4
FLAT_STEPS = 4  # as many under a flat end: its area presses at once, whatever relaxes fast, and a step is one sum
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
    ledger: tuple[LedgerEntry, ...]


@says_which_key
def plan(scene: Scene, given: Given) -> Plan:
    """Choose what ``given`` (checked settings, see :func:`fe_contact.settings.checked`) leaves open, without waves.

    Raises NotReached where even a coarse estimate does not come to an end.
    """
    check_kind(given, False, scene.source)
    tolerance = float(given.get("tolerance", DEFAULT_TOLERANCE))
    chosen = _settings(scene, tolerance)
    size = scales(scene, chosen)
    # gravity holds what does not separate, and swings it; a dashpot may answer most at the touch
    held = max(2.0 * size.peak_time, scene.elastic_contact_time)
    contact_time = size.duration or (min(held, scene.end_time) if scene.gravity > 0.0 else scene.end_time)
    peak_share = share_of_peak(size.peak_time, contact_time)
    placed = chosen.varied(
        steps=_steps(tolerance, peak_share, FLAT_STEPS if _flat(scene) else 1),
        contact_radius=size.contact_radius * (SPARE if _stays(scene) else 1.0),
        contact_time=contact_time,
        peak_share=peak_share,
    )
    peak = Peak(size.peak_force, size.peak_depth, size.contact_radius, 2 * size.peak_time)
    return Plan(placed.varied(**given), frozenset(given) - {"tolerance"}, model_ledger(scene, peak))


def share_of_peak(peak_time: float, contact_time: float) -> float:
    """Time of the force's peak over that of the contact; one that falls from the touch on has no rise to resolve."""
    share = peak_time / contact_time
    return min(max(share, SOONEST_PEAK), 1.0) if share > AT_TOUCH else 0.5


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
    fewest = FIXED_ELEMENTS if _stays(scene) else ELEMENTS
    if not _stays(scene) and not _flat(scene):
        fewest *= math.pow(min(max(1e-4 / tolerance, 0.1), 1.0), LOOSER)
    finer = max(1.0, math.pow(1e-4 / tolerance, 0.25), math.pow(DEFAULT_TOLERANCE / tolerance, order))
    return round(fewest * finer, 6)


def _stays(scene: Scene) -> bool:
    """Whether the mesh stays and the contact may end anywhere in it."""
    return scene.geometry.target.has_length and not _flat(scene)


def _flat(scene: Scene) -> bool:
    """Whether a flat end presses the same area from the first touch to the last."""
    return scene.geometry.target.fixed_radius(scene.geometry.shape) is not None


def _steps(tolerance: float, peak_share: float, finer: int) -> int:
    """Time steps per contact, so many times `finer`, a multiple of four so that the budget can halve them twice."""
    early = max(1.0, EARLY_PEAK / peak_share)
    wanted = early * STEPS_AT_DEFAULT * max(DEFAULT_TOLERANCE / tolerance, 1.0) ** STEPS_ORDER
    return int(min(4 * finer * math.ceil(wanted / 4), RANGES["steps"][1]))
