"""A deformable ball that strikes a rigid plane: in free flight before and after, its own waves stay in it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from fe_contact.assembly.forms import check_compressible
from fe_contact.budget.plan import Plan
from fe_contact.progress import Progress, silent
from fe_contact.settings import RANGES
from fe_contact.waves.cost import Cost
from fe_contact.waves.flying_ball import on_plane
from fe_contact.waves.numerics import WaveNumerics
from fe_contact.waves.plan import SPRINGS, placed
from fe_contact.waves.refining import cost_of, refined_to_tolerance
from fe_contact.waves.refusals import changing, too_fast
from lumped.errors import BadInput
from lumped.laws import mdr
from lumped.laws.mdr import ImpactScales
from lumped.result.result import Result
from lumped.scene.scene import Scene


def plan(scene: Scene, given: Mapping[str, Any]) -> Plan:
    """Choose what ``given`` (checked settings) leaves open; the far end is that of the ball.

    Raises NotReached where even the row of springs does not come to an end.
    """
    return flying(scene, given, mdr.estimate(scene, SPRINGS), scene.geometry.shape.tip_radius or 0.0)


def flying(scene: Scene, given: Mapping[str, Any], scales: ImpactScales, radius: float) -> Plan:
    """What ``given`` leaves open for an impact of these scales on bodies that end with a ball of this radius, m."""
    check_compressible(scene)
    low, high = RANGES["far_radius"]
    return placed(scene, given, scales, min(max(2.0 * radius / scales.contact_radius, low), high))


def cost(scene: Scene, numerics: WaveNumerics) -> Cost:
    """Of an error budget with these settings. Raises BodyTooFine."""
    return cost_of(scene, numerics, on_plane)


def fe(scene: Scene, given: Mapping[str, Any], progress: Progress = silent) -> Result:
    """Force history with error bars. Raises BadInput for a scene it is not for, NotReached where no march ends."""
    check(scene)
    return refined_to_tolerance(scene, plan(scene, given), on_plane, progress)


def check(scene: Scene) -> None:
    """Raise BadInput for several impacts, one too fast, and a changing Poisson's ratio."""
    scene.check_single("fe, where the ball rings on between contacts,")
    faults = [*too_fast(scene), *changing(scene)]
    if faults:
        raise BadInput(faults)
