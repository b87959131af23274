"""An impact with waves refined until its bars meet the tolerance, by no more than the measured budget says is missing.

A cause's error is predicted to fall with the order that its bar trusts. The settings are raised one small step after
the other, each time the one that takes most from the widest bar for its work, until all bars are predicted to hold.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget.certify import Budget
from fe_contact.budget.plan import SETTING, Plan
from fe_contact.errors import MemoryTooSmall
from fe_contact.progress import Count, Progress
from fe_contact.reference import result_of, strike_of
from fe_contact.results.told import quantities_of, shares_of
from fe_contact.settings import RANGES, Numerics
from fe_contact.waves.certify import ORDER, WaveRuns, certify, other_mesh
from fe_contact.waves.cost import Cost
from fe_contact.waves.moving import Moving
from fe_contact.waves.numerics import WaveNumerics
from lumped.errors import NotReached
from lumped.result.result import Result, meets
from lumped.scene.scene import Scene

ROUNDS = 3  # refinements before giving up
WIDER = 1.5  # the mesh again where the contact outgrew it
AIM = 0.9  # of the tolerance: predictions err too
STEP = {"mesh": 2**0.25, "penalty": 2.0, "time_step": 2.0, "far_field": 2.0}  # twice: half of them has been run
WORK = {"mesh": 2.0, "penalty": 0.1, "time_step": 1.0, "far_field": 0.3}  # what a march costs goes as the setting to it
MOST = {"mesh": 2.0, "penalty": 8.0, "time_step": 4.0, "far_field": 4.0}  # in one round


@dataclass(frozen=True, eq=False)
class SolvedWaves:
    """A certified impact with the plan it began from and the settings it ended with; CPU and wall time, s."""

    plan: Plan
    numerics: Numerics
    certified: Budget
    cpu: float
    wall: float
    refused: str = ""


def refined_to_tolerance(
    scene: Scene, chosen: Plan, moving: Callable[[Scene, WaveNumerics], Moving], progress: Progress
) -> Result:
    """Certify as planned, refine until the bars meet the tolerance or nothing is left; ``moving`` makes the body.

    Raises NotReached where no march ends or the first budget costs too much, BadInput for an impact that goes deeper
    than its bodies.
    """
    cpu, wall = time.process_time(), time.perf_counter()
    assert isinstance(chosen.numerics, WaveNumerics)
    numerics, certified, outgrown = chosen.numerics, None, None
    runs = WaveRuns(scene, strike_of(scene), moving, numerics.steps // 2)
    finer = numerics
    for attempt in range(ROUNDS + 1):
        try:
            cost = cost_of(scene, finer, moving)
            cost.check(runs.spent)
            progress(f"waves, {cost}")
            runs.counted = Count(progress, f"waves, {cost.unknowns} unknowns", cost.all_steps)
            certified, numerics = certify(runs, finer), finer
        except MemoryTooSmall as failure:
            outgrown = failure
            finer = finer.varied(contact_radius=WIDER * finer.contact_radius)
            continue
        except NotReached:
            if certified is None:
                raise
            break  # finer settings cost too much or lose their way: what is known stands, with its bars
        finer = refined(certified, numerics, chosen.pinned)
        if finer == numerics or attempt == ROUNDS:
            break
    if certified is None:
        raise outgrown or MemoryTooSmall(numerics.contact_radius)
    scene.check_sunk(max(budget.curve.quantities["peak_depth"] or 0.0 for budget in certified.row))
    solved = SolvedWaves(chosen, numerics, certified, time.process_time() - cpu, time.perf_counter() - wall)
    return result_of(scene, solved)


def cost_of(scene: Scene, numerics: WaveNumerics, moving: Callable[[Scene, WaveNumerics], Moving]) -> Cost:
    """What one error budget costs with these settings. Raises BodyTooFine."""
    own, judging = (moving(scene, one).body.size for one in (numerics, other_mesh(numerics)[0]))
    return Cost.of(own, numerics, scene.motion.impacts, judging if judging > own else 0)


def refined(certified: Budget, numerics: WaveNumerics, pinned: frozenset[str]) -> WaveNumerics:
    """Settings whose bars are predicted to meet the tolerance; the same where they do, or where all is ``pinned``."""
    if all(meets(quantities_of(one), numerics.tolerance) for one in certified.row):
        return numerics
    shares = {
        cause: np.concatenate([shares_of(one, cause, numerics.tolerance) for one in certified.row]) for cause in ORDER
    }
    return _raised(numerics, factors(shares, {cause: _room(numerics, cause, pinned) for cause in ORDER}))


def factors(shares: Mapping[str, Array], room: Mapping[str, float]) -> dict[str, float]:
    """By how much to raise the setting of every cause, up to its ``room``.

    ``shares`` (quantities,) of the tolerance that every cause takes of each, infinite where it is unknown.
    """
    chosen = dict.fromkeys(shares, 1.0)
    while True:
        left = {cause: share / chosen[cause] ** ORDER[cause] for cause, share in shares.items()}
        bars = np.sum(list(left.values()), axis=0)
        free = [cause for cause in shares if chosen[cause] * STEP[cause] <= room[cause] and left[cause].any()]
        if bars.max() <= AIM or not free:
            return chosen
        widest = int(bars.argmax())
        best = max(free, key=lambda cause: _worth(float(left[cause][widest]), cause))
        chosen[best] *= STEP[best]


def _worth(share: float, cause: str) -> float:
    """What one step more takes from a bar, per work."""
    return share * (1.0 - STEP[cause] ** -ORDER[cause]) / (WORK[cause] * math.log(STEP[cause]))


def _room(numerics: WaveNumerics, cause: str, pinned: frozenset[str]) -> float:
    """The factor by which the setting of a cause may be raised in one round."""
    key = SETTING[cause]
    return 1.0 if key in pinned else min(MOST[cause], RANGES[key][1] / getattr(numerics, key))


def _raised(numerics: WaveNumerics, by: Mapping[str, float]) -> WaveNumerics:
    finer = numerics
    for cause, factor in by.items():
        value = factor * getattr(numerics, SETTING[cause])
        finer = finer.varied(**{SETTING[cause]: int(value) if cause == "time_step" else value})
    return finer
