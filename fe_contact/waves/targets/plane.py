"""What strikes a rigid plane with waves of its own: a block, a bar of line elements, or a ball, meshed whole."""

from __future__ import annotations

from typing import Any

from fe_contact.budget.plan import Plan
from fe_contact.budget.refine import ImpactWay
from fe_contact.progress import Progress
from fe_contact.settings import Given, WaveNumerics
from fe_contact.waves.cost import Cost
from fe_contact.waves.targets._ball import BALL
from fe_contact.waves.targets._block import BLOCK
from fe_contact.waves.targets.base import WaveTarget
from lumped.scene.scene import Scene
from lumped.shapes._block import Block


def check(scene: Scene) -> None:
    """Raise BadInput for a scene it is not for."""
    _of(scene).check(scene)


def plan(scene: Scene, given: Given) -> Plan:
    """Choose what ``given`` (checked settings) leaves open."""
    return _of(scene).plan(scene, given)


def cost(scene: Scene, numerics: WaveNumerics) -> Cost:
    """Of an error budget with these settings. Raises BodyTooFine."""
    return _of(scene).cost(scene, numerics)


def way(scene: Scene, chosen: Plan, progress: Progress) -> ImpactWay[Any]:
    """How it is solved."""
    return _of(scene).way(scene, chosen, progress)


def _of(scene: Scene) -> WaveTarget:
    return BLOCK if isinstance(scene.geometry.shape, Block) else BALL


MEMBER = WaveTarget(check=check, plan=plan, cost=cost, way=way)
