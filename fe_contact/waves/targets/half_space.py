"""The half-space with waves: what it radiates never comes back, and its force is smooth."""

from __future__ import annotations

from collections.abc import Callable

from fe_contact.budget.plan import Plan
from fe_contact.progress import Progress
from fe_contact.settings import WaveNumerics
from fe_contact.waves.cost import Cost
from fe_contact.waves.fields import write_fields
from fe_contact.waves.flying_ball import on_half_space
from fe_contact.waves.half_space_body import moving
from fe_contact.waves.moving import Moving
from fe_contact.waves.plan import plan
from fe_contact.waves.refining import Waves, cost_of
from fe_contact.waves.refusals import changing, too_fast
from fe_contact.waves.targets.base import WaveTarget
from lumped.errors import BadInput, Fault
from lumped.scene.scene import Scene


def cost(scene: Scene, numerics: WaveNumerics) -> Cost:
    """Of an error budget with these settings. Raises BodyTooFine."""
    return cost_of(scene, numerics, _body(scene))


def way(scene: Scene, chosen: Plan, progress: Progress) -> Waves:
    """Marched with waves, refined by what is missing."""
    return Waves.of(scene, chosen, _body(scene), progress)


def _body(scene: Scene) -> Callable[[Scene, WaveNumerics], Moving]:
    return moving if scene.striker_material is None else on_half_space


def check(scene: Scene) -> None:
    """Raise BadInput for a striker with a rim, in plane strain, or that rings on between impacts, and a changing nu."""
    if scene.striker_material is not None:
        scene.check_single("fe, where the ball rings on between contacts,")
    shape, faults = scene.geometry.shape, [*too_fast(scene), *changing(scene)]
    if shape.plane or shape.fixed_radius is not None:
        reason = f"{shape.name}: no waves under it in this version; accepted with model.inertia: sphere, cone, power"
        faults.append(Fault(scene.source, "striker.shape", reason))
    if faults:
        raise BadInput(faults)


MEMBER = WaveTarget(check=check, plan=plan, cost=cost, way=way, write_fields=write_fields)
