"""A free ball struck by a ball, both with waves: they fly apart with what stays in each of them."""

from __future__ import annotations

from dataclasses import replace

from fe_contact.budget.plan import Plan
from fe_contact.progress import Progress
from fe_contact.settings import Given, WaveNumerics
from fe_contact.waves.cost import Cost
from fe_contact.waves.flying_ball import on_ball
from fe_contact.waves.refining import Waves, cost_of
from fe_contact.waves.targets._ball import check, flying
from fe_contact.waves.targets.base import WaveTarget
from lumped.laws import correspondence
from lumped.scene.scene import Scene
from lumped.targets.sphere import SphereTarget


def plan(scene: Scene, given: Given) -> Plan:
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


def way(scene: Scene, chosen: Plan, progress: Progress) -> Waves:
    """Marched with waves, refined by what is missing."""
    return Waves.of(scene, chosen, on_ball, progress)


MEMBER = WaveTarget(check=check, plan=plan, cost=cost, way=way)
