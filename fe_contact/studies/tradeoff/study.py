"""What accuracy costs: error against the exact impact over processor time and counted work, by every method.

A finite-element point is what a user gets: the history with its error bars, from nothing but loaded modules,
so every operator is built again for every point. The exact impact is the row of springs far beyond any
tolerance, and Ting's solution for the row of springs itself.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, replace
from functools import cache, partial
from pathlib import Path

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget.certify import Certified, certify
from fe_contact.budget.runs import operations
from fe_contact.progress import Progress
from fe_contact.reference import check_target
from fe_contact.settings import Given, Numerics
from fe_contact.steppers.march import Strike
from fe_contact.studies import journal
from fe_contact.studies.tradeoff.design import defaults, variations
from fe_contact.studies.tradeoff.point import Point, errors_of, largest_bar, timed, values_of
from fe_contact.targets import half_space
from lumped import laws, simulate
from lumped.errors import FeContactError, NotReached
from lumped.laws import mdr
from lumped.result.result import Result
from lumped.scene.scene import Scene

EXACT_TOLERANCE = 1e-8
ROUNDS = 3  # through all settings: the least of so many times counts, and a slow spell of the machine hits all alike
REPEATS = 2  # of what takes milliseconds
ROW_ELEMENTS = (25, 50, 100, 200, 400)
LAW_TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
KEPT = "tradeoff.jsonl"
MODELS = ("hertz", "correspondence")

Exact = Callable[[], Result]  # computed where a point is still to measure


def tradeoff(scene: Scene, given: Given, quick: bool, where: Path, progress: Progress) -> tuple[Point, ...]:
    """Measure every point of the study; points are kept, with the time they took, in the folder `where`.

    Raises NotReached where the exact impact itself has no answer.
    """
    scene.check_single("tradeoff")
    check_target(scene)
    planned = defaults(scene, given)
    base = next(iter(planned.values()))
    marked = {n.varied(tolerance=base.tolerance): tolerance for tolerance, n in planned.items()}
    chosen = tuple(dict.fromkeys((*marked, *variations(base, given, quick))))

    @cache
    def exact() -> Result:
        _certify(scene, chosen[0])  # imports and the processor's warm-up belong to no point
        return _simulate(scene, "mdr", EXACT_TOLERANCE)

    elements = {
        f"finite elements {place} of {len(chosen)}, time {count} of {ROUNDS}": partial(
            _fe, scene, numerics, marked.get(numerics), count, exact=exact
        )
        for count in range(1, ROUNDS + 1)
        for place, numerics in enumerate(chosen, 1)
    }
    calls = elements | _rows(scene, exact) | _laws(scene, exact, quick)
    found = list(journal.rows(where / KEPT, calls, progress).values())
    tried, others = found[: len(elements)], found[len(elements) :]
    rounds = [tried[place :: len(chosen)] for place in range(len(chosen))]
    return (*(replace(first, cpu=min(first.cpu, *(one.cpu for one in again))) for first, *again in rounds), *others)


def _fe(scene: Scene, numerics: Numerics, default_for: float | None, count: int, exact: Exact) -> Point:
    """A choice of settings, measured for the so-manieth time."""
    truth = exact()
    settings = numerics.as_dict() | {"tolerance": default_for}
    try:
        certified, cpu = timed(partial(_certify, scene, numerics), 1)
    except NotReached as failure:
        return Point("fe", settings, default_for=default_for, failure=str(failure))
    curve = certified.curve
    errors = _errors(truth, curve.quantities, curve.dense_time, curve.dense_force)
    bars = [certified.total("history_l2"), certified.total("restitution") if "restitution" in errors else 0.0]
    bars += [certified.total(name) / abs(curve.quantities[name] or np.inf) for name in ("peak_force", "duration")]
    work = asdict(certified.work) | {"operations": operations(certified.work, certified.surface)}
    return Point("fe", settings, cpu, errors, max(bars), work, default_for)


def _certify(scene: Scene, numerics: Numerics) -> Certified:
    """A certified impact with no operator at hand."""
    half_space._surface.cache_clear()
    return certify(Strike.of(scene), scene.geometry, numerics)


def _rows(scene: Scene, exact: Exact) -> dict[str, partial[Point]]:
    """The row of springs at fixed numbers of elements."""
    return {f"row of {count} springs": partial(_row, scene, count, exact=exact) for count in ROW_ELEMENTS}


def _row(scene: Scene, elements: int, exact: Exact) -> Point:
    """One march, no bar, no history."""
    truth = exact()
    scales, cpu = timed(partial(mdr.estimate, scene, elements=elements), REPEATS)
    return Point("mdr row", {"elements": elements}, cpu, _errors(truth, vars(scales)), work={"elements": elements})


def _laws(scene: Scene, exact: Exact, quick: bool) -> dict[str, partial[Point]]:
    """Exact laws at several tolerances with their bars; the models, which err however finely they are integrated."""
    tolerances = LAW_TOLERANCES[::2] if quick else LAW_TOLERANCES
    chosen = [(name, tolerance) for name in ("mdr", "ting") for tolerance in tolerances]
    other = cache(partial(_simulate, scene, "ting", EXACT_TOLERANCE))
    return {
        f"{name} to {tolerance:g}": partial(_law, scene, name, tolerance, exact=other if name == "mdr" else exact)
        for name, tolerance in [*chosen, *((name, LAW_TOLERANCES[-2]) for name in MODELS)]
    }


def _law(scene: Scene, name: str, tolerance: float, exact: Exact) -> Point:
    truth, settings = exact(), {"tolerance": tolerance}
    try:
        result, cpu = timed(partial(_simulate, scene, name, tolerance), REPEATS)
    except FeContactError as failure:
        return Point(name, settings, failure=str(failure))
    errors = _errors(truth, values_of(result), result.history.time, result.history.force)
    return Point(name, settings, cpu, errors, largest_bar(result), dict(result.work))


def _simulate(scene: Scene, name: str, tolerance: float) -> Result:
    """A lumped law's answer."""
    return simulate(laws.get(name).of(scene), scene, tolerance)


def _errors(exact: Result, values: Given, time: Array | None = None, force: Array | None = None) -> dict[str, float]:
    """Errors of the measured quantities that both define, and of the history where there is one."""
    found = errors_of(values_of(exact), values)
    if time is not None and force is not None:
        found["history"] = _distance(exact, time, force)
    return found


def _distance(exact: Result, time: Array, force: Array) -> float:
    """Norm of the force's error over the norm of the force, at the rows of a history, zero after its end."""
    late = exact.history.time[exact.history.time > time[-1]]
    times = np.concatenate([time, late])
    forces = np.concatenate([force, np.zeros_like(late)])
    truth = exact.history.force_at(times)
    return float(np.sqrt(np.trapezoid((forces - truth) ** 2, times) / np.trapezoid(truth**2, times)))
