"""What accuracy costs: error against the exact impact over processor time and counted work, by every method.

A finite-element point is what a user gets: the history with its error bars, from nothing but loaded modules,
so every operator is built again for every point. The exact impact is the row of springs far beyond any
tolerance, and Ting's solution for the row of springs itself.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, replace
from functools import partial
from typing import Any

import numpy as np

from fe_contact.bodies.struck import Deformable
from fe_contact.certify import Certified, certify
from fe_contact.forms import Array
from fe_contact.numerics import Numerics
from fe_contact.progress import Progress
from fe_contact.reference import check_target, strike_of
from fe_contact.runs import TotalWork
from fe_contact.targets import half_space
from fe_contact.validation.design import defaults, variations
from fe_contact.validation.point import Point, errors_of, largest_bar, timed, values_of
from lumped import laws, simulate
from lumped.errors import FeContactError, NotReached
from lumped.result import Result
from lumped.scene import Scene

EXACT_TOLERANCE = 1e-8
ROUNDS = 3  # through all settings: the least of so many times counts, and a slow spell of the machine hits all alike
REPEATS = 2  # of what takes milliseconds
ROW_ELEMENTS = (25, 50, 100, 200, 400)
LAW_TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
MODELS = ("hertz", "correspondence")



def tradeoff(scene: Scene, given: Mapping[str, Any], quick: bool, progress: Progress) -> tuple[Point, ...]:
    """Measure every point of the study. Raises NotReached where the exact impact itself has no answer."""
    scene.check_single("tradeoff")
    check_target(scene)
    exact = _simulate(scene, "mdr", EXACT_TOLERANCE)
    planned = defaults(scene, given)
    base = next(iter(planned.values()))
    marked = {n.varied(tolerance=base.tolerance): tolerance for tolerance, n in planned.items()}
    chosen = tuple(dict.fromkeys((*marked, *variations(base, given, quick))))
    _certify(scene, chosen[0])  # imports and the processor's warm-up belong to no point
    points = []
    for count, numerics in enumerate(chosen, 1):
        progress("finite elements", count - 1, len(chosen))
        points.append(_fe(scene, numerics, exact, marked.get(numerics)))
    for count in range(2, ROUNDS + 1):
        progress("finite elements again", count - 2, ROUNDS - 1)
        points = [_again(scene, numerics, point) for numerics, point in zip(chosen, points, strict=True)]
    progress("exact laws and models")
    return (*points, *_rows(scene, exact), *_laws(scene, exact, quick))


def operations(work: TotalWork, surface: Deformable) -> float:
    """Leading terms of the arithmetic behind the counted work, with the sizes of the finest mesh.

    N unknowns in the plane cost N^(3/2) a factorisation and N log2 N a back-substitution (George 1973,
    doi:10.1137/0710032); n surface unknowns and q quadrature points n^2 q + n^3/3 a Newton iteration.
    """
    unknowns, (points, zone) = float(work.degrees_of_freedom), surface.operator.trace.shape
    condensation = work.factorizations * unknowns**1.5 + work.solves * unknowns * np.log2(unknowns)
    return float(condensation + work.iterations * (zone**2 * points + zone**3 / 3))


def _fe(scene: Scene, numerics: Numerics, exact: Result, default_for: float | None) -> Point:
    settings = numerics.as_dict() | {"tolerance": default_for}
    try:
        certified, cpu = timed(partial(_certify, scene, numerics), 1)
    except NotReached as failure:
        return Point("fe", settings, default_for=default_for, failure=str(failure))
    curve = certified.curve
    errors = _errors(exact, curve.quantities, curve.dense_time, curve.dense_force)
    bars = [certified.total("history_l2"), certified.total("restitution") if "restitution" in errors else 0.0]
    bars += [certified.total(name) / abs(curve.quantities[name] or np.inf) for name in ("peak_force", "duration")]
    assert isinstance(certified.surface, Deformable)
    work = asdict(certified.work) | {"operations": operations(certified.work, certified.surface)}
    return Point("fe", settings, cpu, errors, max(bars), work, default_for)


def _again(scene: Scene, numerics: Numerics, point: Point) -> Point:
    """The same point with the lesser of two times."""
    if point.failure:
        return point
    _, cpu = timed(partial(_certify, scene, numerics), 1)
    return replace(point, cpu=min(cpu, point.cpu))


def _certify(scene: Scene, numerics: Numerics) -> Certified:
    """A certified impact with no operator at hand."""
    half_space._surface.cache_clear()
    return certify(strike_of(scene), scene.geometry, numerics)


def _rows(scene: Scene, exact: Result) -> Iterator[Point]:
    """The row of springs at fixed numbers of elements: one march, no bar, no history."""
    row = laws.get("mdr")
    for elements in ROW_ELEMENTS:
        scales, cpu = timed(partial(row.estimate, scene, elements=elements), REPEATS)
        errors = _errors(exact, vars(scales))
        yield Point("mdr row", {"elements": elements}, cpu, errors, work={"elements": elements})


def _laws(scene: Scene, exact: Result, quick: bool) -> Iterator[Point]:
    """Exact laws at several tolerances with their bars; the models, which err however finely they are integrated."""
    tolerances = LAW_TOLERANCES[::2] if quick else LAW_TOLERANCES
    chosen = [(name, tolerance) for name in ("mdr", "ting") for tolerance in tolerances]
    other = _simulate(scene, "ting", EXACT_TOLERANCE)
    for name, tolerance in [*chosen, *((name, LAW_TOLERANCES[-2]) for name in MODELS)]:
        settings = {"tolerance": tolerance}
        try:
            result, cpu = timed(partial(_simulate, scene, name, tolerance), REPEATS)
        except FeContactError as failure:
            yield Point(name, settings, failure=str(failure))
            continue
        truth = other if name == "mdr" else exact
        errors = _errors(truth, values_of(result), result.history.time, result.history.force)
        yield Point(name, settings, cpu, errors, largest_bar(result), dict(result.work))


def _simulate(scene: Scene, name: str, tolerance: float) -> Result:
    """A lumped law's answer."""
    return simulate(laws.get(name).of(scene), scene, tolerance)


def _errors(
    exact: Result, values: Mapping[str, Any], time: Array | None = None, force: Array | None = None
) -> dict[str, float]:
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
