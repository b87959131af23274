"""An impact whose waves run along a line: its steps doubled until its bars meet the tolerance."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from functools import cache

from fe_contact.budget.plan import Plan
from fe_contact.progress import Progress
from fe_contact.waves.numerics import WaveNumerics
from fe_contact.waves.rod_record import Bars, Run, result_of
from lumped.result.result import Result, meets
from lumped.scene.scene import Scene

ROUNDS = 3  # refinements before giving up
STEP = 2_000  # unknowns whose share of a step takes as long as all the rest of it
MOST_WORK = 1e8  # unknowns, and those of a step itself, times steps, of all marches: some fifteen seconds


def certified(
    scene: Scene,
    chosen: Plan,
    run: Callable[[WaveNumerics], Run],
    varied: Callable[[WaveNumerics], Mapping[str, WaveNumerics]],
    most_steps: float,
    progress: Progress,
) -> Result:
    """March as planned and with one cause of error ``varied`` at a time; again with twice the steps, ``most_steps`` at
    most, where a bar is too wide and the work allows it. Raises NotReached where a march does not end.

    Each march is made once: with twice the steps, the one before is what half of them give.
    """
    cpu, wall = time.process_time(), time.perf_counter()
    numerics, marched = chosen.numerics, cache(run)
    runs = dict[Run, None]()
    for attempt in range(ROUNDS + 1):
        assert isinstance(numerics, WaveNumerics)
        progress(f"{numerics.steps} steps of waves along a line")
        others = varied(numerics)
        quarter = marched(varied(others["time_step"])["time_step"])
        found = Bars(marched(numerics), {cause: marched(settings) for cause, settings in others.items()}, quarter)
        runs |= dict.fromkeys(found.runs)
        stuck = "steps" in chosen.pinned or attempt == ROUNDS or 2 * numerics.steps > most_steps
        twice = _work(2 * found.fine.steps, 2 * found.fine.unknowns)
        dear = twice + sum(_work(one.steps, one.unknowns) for one in runs) > MOST_WORK
        if stuck or dear or meets(found.quantities, numerics.tolerance):
            break
        numerics = numerics.varied(steps=2 * numerics.steps)
    timing = {"cpu_s": time.process_time() - cpu, "wall_s": time.perf_counter() - wall}
    return result_of(scene, chosen, numerics, found, timing, list(runs))


def _work(steps: int, unknowns: int) -> float:
    """Of a march."""
    return float(steps) * (unknowns + STEP)
