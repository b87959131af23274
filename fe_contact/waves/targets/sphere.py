"""A free ball struck by a ball, both with waves: they fly apart with what stays in each of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from fe_contact.budget.plan import Plan
from fe_contact.progress import Progress, silent
from fe_contact.waves.cost import Cost
from fe_contact.waves.falling_ball import check, flying
from fe_contact.waves.flying_ball import on_ball
from fe_contact.waves.numerics import WaveNumerics
from fe_contact.waves.refining import cost_of, refined_to_tolerance
from lumped.laws import correspondence
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.targets.sphere import SphereTarget


def plan(scene: Scene, given: Mapping[str, Any]) -> Plan:
    """Choose what ``given`` (checked settings) leaves open; two half-spaces without inertia place mesh and steps.

    Raises NotReached where even that does not come to an end.
    """
    target, own = scene.target, scene.geometry.shape.tip_radius
    assert isinstance(target, SphereTarget)
    without = replace(scene, target=replace(target, support=None), model=replace(scene.model, inertia=False))
    return flying(scene, given, correspondence.estimate(without), max(target.radius, own or 0.0))


def cost(scene: Scene, numerics: WaveNumerics) -> Cost:
    """Of an error budget with these settings. Raises BodyTooFine."""
    return cost_of(scene, numerics, on_ball)


def fe(scene: Scene, given: Mapping[str, Any], progress: Progress = silent) -> Result:
    """Force history with error bars. Raises BadInput for a scene it is not for, NotReached where no march ends."""
    check(scene)
    return refined_to_tolerance(scene, plan(scene, given), on_ball, progress)
