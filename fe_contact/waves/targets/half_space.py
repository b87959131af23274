"""The half-space with waves: what it radiates never comes back, and its force is smooth."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from fe_contact.progress import Progress, silent
from fe_contact.waves.cost import Cost
from fe_contact.waves.fields import write_fields as write_fields
from fe_contact.waves.flying_ball import on_half_space
from fe_contact.waves.half_space_body import moving
from fe_contact.waves.moving import Moving
from fe_contact.waves.numerics import WaveNumerics
from fe_contact.waves.plan import plan as plan
from fe_contact.waves.refining import cost_of, refined_to_tolerance
from fe_contact.waves.refusals import changing, too_fast
from lumped.errors import BadInput, Fault
from lumped.result.result import Result
from lumped.scene.scene import Scene


def cost(scene: Scene, numerics: WaveNumerics) -> Cost:
    """Of an error budget with these settings. Raises BodyTooFine."""
    return cost_of(scene, numerics, _body(scene))


def fe(scene: Scene, given: Mapping[str, Any], progress: Progress = silent) -> Result:
    """Force history with error bars. Raises BadInput for a scene it is not for, NotReached where no march ends."""
    check(scene)
    return refined_to_tolerance(scene, plan(scene, given), _body(scene), progress)


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
