"""A deformable ball that strikes a rigid plane: in free flight before and after, its own waves stay in it."""

from __future__ import annotations

from fe_contact.assembly.forms import check_compressible
from fe_contact.budget.plan import Plan
from fe_contact.progress import Progress
from fe_contact.settings import RANGES, Given, WaveNumerics
from fe_contact.waves.cost import Cost
from fe_contact.waves.flying_ball import on_plane
from fe_contact.waves.plan import SPRINGS, placed
from fe_contact.waves.refining import Waves, cost_of
from fe_contact.waves.refusals import changing, too_fast
from fe_contact.waves.targets.base import WaveTarget
from lumped.errors import BadInput
from lumped.laws import mdr
from lumped.laws.mdr import ImpactScales
from lumped.scene.scene import Scene


def plan(scene: Scene, given: Given) -> Plan:
    """Choose what ``given`` (checked settings) leaves open; the far end is that of the ball.

    Raises NotReached where even the row of springs does not come to an end.
    """
    return flying(scene, given, mdr.estimate(scene, SPRINGS), scene.geometry.shape.tip_radius or 0.0)


def flying(scene: Scene, given: Given, scales: ImpactScales, radius: float) -> Plan:
    """What ``given`` leaves open for an impact of these scales on bodies that end with a ball of this radius, m."""
    check_compressible(scene)
    low, high = RANGES["far_radius"]
    return placed(scene, given, scales, min(max(2.0 * radius / scales.contact_radius, low), high))


def cost(scene: Scene, numerics: WaveNumerics) -> Cost:
    """Of an error budget with these settings. Raises BodyTooFine."""
    return cost_of(scene, numerics, on_plane)


def way(scene: Scene, chosen: Plan, progress: Progress) -> Waves:
    """Marched with waves, refined by what is missing."""
    return Waves.of(scene, chosen, on_plane, progress)


def check(scene: Scene) -> None:
    """Raise BadInput for several impacts, one too fast, and a changing Poisson's ratio."""
    scene.check_single("fe, where the ball rings on between contacts,")
    faults = [*too_fast(scene), *changing(scene)]
    if faults:
        raise BadInput(faults)


BALL = WaveTarget(check=check, plan=plan, cost=cost, way=way)
