"""What a target with inertia is, and scenes that waves are not for, each with its reason."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from fe_contact.budget.plan import Plan
from fe_contact.budget.refine import ImpactWay
from fe_contact.progress import Progress
from fe_contact.settings import Given, WaveNumerics
from fe_contact.waves.certify import Body, Units, Waves, cost_of
from fe_contact.waves.plan import Cost
from lumped.errors import BadInput, Fault
from lumped.materials.radiation import shear_speed
from lumped.result.result import Result
from lumped.scene.geometry import changing_faults
from lumped.scene.scene import Scene
from lumped.schema.members import Folder

FASTEST = 0.3  # of the speed of shear waves: beyond, strains are not small anywhere


@dataclass(frozen=True)
class WaveTarget:
    """``check(scene)`` raises BadInput for a scene it is not for; ``plan(scene, given)``: settings chosen for another;
    ``cost(scene, numerics)``: what an error budget with them takes; ``way(scene, chosen, progress)``: how it is solved;
    ``write_fields(scene, result, where)``: its fields at the peak, None where there are none in this version.
    """

    check: Callable[[Scene], None]
    plan: Callable[[Scene, Given], Plan]
    cost: Callable[[Scene, WaveNumerics], Cost]
    way: Callable[[Scene, Plan, Progress], ImpactWay[Any]]
    write_fields: Callable[[Scene, Result, Path], Path] | None = None

    @classmethod
    def meshed(
        cls,
        check: Callable[[Scene], None],
        plan: Callable[[Scene, Given], Plan],
        units: Units,
        moving: Body,
        write_fields: Callable[[Scene, Result, Path], Path] | None = None,
    ) -> WaveTarget:
        """One whose bodies ``moving`` makes, scaled from ``units``: marched with waves, refined by what is missing."""
        cost = partial(cost_of, units=units)
        return cls(check, plan, cost, partial(Waves.of, cost=cost, moving=moving), write_fields)


WAVES = Folder[WaveTarget]("fe_contact.waves.targets", "numerics", "target")


def too_fast(scene: Scene) -> list[Fault]:
    """Nearer to the speed of shear waves than small displacements reach."""
    speeds = [speed for _, material in scene.geometry.yielding if (speed := shear_speed(material)) is not None]
    speed = min(speeds, default=math.inf)
    if scene.velocity < FASTEST * speed:
        return []
    reason = f"{scene.velocity:g} m/s: accepted below {FASTEST:g} of the speed of shear waves, {speed:.3g} m/s"
    return [Fault(scene.source, "striker.velocity", reason)]


def check_balls(scene: Scene) -> None:
    """Raise BadInput for several impacts of a ball that yields, one too fast, and a changing Poisson's ratio."""
    scene.check_single("fe, where the ball rings on between contacts,")
    faults = [*too_fast(scene), *changing_faults(scene.source, scene.geometry)]
    if faults:
        raise BadInput(faults)
