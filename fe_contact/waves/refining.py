"""An impact on a body with waves, from its plan to the certified record: refined until the bars meet the tolerance."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from fe_contact.certify import Budget
from fe_contact.errors import MemoryTooSmall
from fe_contact.numerics import Numerics
from fe_contact.plan import Plan
from fe_contact.progress import Progress
from fe_contact.reference import refined_for, result_of, strike_of
from fe_contact.waves.certify import certify
from fe_contact.waves.moving import Moving
from fe_contact.waves.numerics import WaveNumerics
from lumped.result import Result
from lumped.scene import Scene

ROUNDS = 2  # refinements before giving up
WIDER = 1.5  # the mesh again where the contact outgrew it


@dataclass(frozen=True, eq=False)
class Solved:
    """A certified impact with the plan it began from and the settings it ended with; CPU and wall time, s."""

    plan: Plan
    numerics: Numerics
    certified: Budget
    cpu: float
    wall: float


def refined_to_tolerance(
    scene: Scene, chosen: Plan, moving: Callable[[Scene, WaveNumerics], Moving], progress: Progress
) -> Result:
    """Certify, refine until the bars meet the tolerance or nothing is left to refine; ``moving`` makes the body.

    Raises NotReached where no march ends, BadInput for an impact that goes deeper than its bodies.
    """
    cpu, wall = time.process_time(), time.perf_counter()
    assert isinstance(chosen.numerics, WaveNumerics)
    numerics, certified, outgrown = chosen.numerics, None, None
    for attempt in range(ROUNDS + 1):
        progress(f"{numerics.steps} steps, {numerics.elements_per_contact:g} elements, waves")
        try:
            certified = certify(scene, strike_of(scene), numerics, moving)
        except MemoryTooSmall as failure:
            outgrown = failure
            numerics = numerics.varied(contact_radius=WIDER * numerics.contact_radius)
            continue
        finer = refined_for(certified, numerics, chosen)
        if not isinstance(finer, WaveNumerics) or attempt == ROUNDS:
            break
        numerics = finer
    if certified is None:
        raise outgrown or MemoryTooSmall(numerics.contact_radius)
    scene.check_sunk(certified.curve.quantities["peak_depth"] or 0.0)
    solved = Solved(chosen, numerics, certified, time.process_time() - cpu, time.perf_counter() - wall)
    return result_of(scene, solved)
