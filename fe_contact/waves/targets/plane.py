"""What strikes a rigid plane with waves of its own: a block, a bar of line elements, or a ball, meshed whole."""

from __future__ import annotations

from collections.abc import Mapping
from types import ModuleType
from typing import Any

from fe_contact.budget.plan import Plan
from fe_contact.progress import Progress, silent
from fe_contact.waves import falling_ball, falling_block
from fe_contact.waves.cost import Cost
from fe_contact.waves.numerics import WaveNumerics
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.shapes._block import Block


def plan(scene: Scene, given: Mapping[str, Any]) -> Plan:
    """Choose what ``given`` (checked settings) leaves open."""
    found: Plan = _of(scene).plan(scene, given)
    return found


def cost(scene: Scene, numerics: WaveNumerics) -> Cost:
    """Of an error budget with these settings. Raises BodyTooFine."""
    found: Cost = _of(scene).cost(scene, numerics)
    return found


def fe(scene: Scene, given: Mapping[str, Any], progress: Progress = silent) -> Result:
    """History with error bars. Raises BadInput for a scene it is not for, NotReached where no march ends."""
    result: Result = _of(scene).fe(scene, given, progress)
    return result


def _of(scene: Scene) -> ModuleType:
    return falling_block if isinstance(scene.geometry.shape, Block) else falling_ball
