"""What a target with inertia is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fe_contact.budget.plan import Plan
from fe_contact.budget.refine import ImpactWay
from fe_contact.progress import Progress
from fe_contact.settings import Given, WaveNumerics
from fe_contact.waves.cost import Cost
from lumped.result.result import Result
from lumped.scene.scene import Scene
from lumped.schema.members import Folder


@dataclass(frozen=True)
class WaveTarget:
    """``check(scene)`` raises BadInput for a scene it is not for; ``plan(scene, given)``: the settings chosen;
    ``cost(scene, numerics)``: what an error budget with them takes; ``way(scene, chosen, progress)``: how it is solved;
    ``write_fields(scene, result, where)``: its fields at the peak, None where there are none in this version.
    """

    check: Callable[[Scene], None]
    plan: Callable[[Scene, Given], Plan]
    cost: Callable[[Scene, WaveNumerics], Cost]
    way: Callable[[Scene, Plan, Progress], ImpactWay[Any]]
    write_fields: Callable[[Scene, Result, Path], Path] | None = None


WAVES = Folder[WaveTarget]("fe_contact.waves.targets", "numerics", "target")
