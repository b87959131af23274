"""The Pareto front of a trade-off, and how near to it the planned defaults lie, in words.

Error against cost as files: a row a method in CSV, described with the verdict in JSON.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import numpy as np

from fe_contact.settings import RANGES
from fe_contact.studies.tradeoff.point import REFERENCE, Point
from lumped.scene.scene import Scene
from lumped.schema import Table
from lumped.schema.csv_file import write_csv
from lumped.schema.json_file import plain, write_json

NEAR = 2.0  # a default that costs at most this multiple of the cheapest setting that does as well is near the front
WIDEST = RANGES["tolerance"][1]
Measure = Callable[[Point], float]
SCHEMA = "fe-contact/tradeoff/1"
SETTING_COLUMNS = (
    "tolerance", "elements", "order", "elements_per_contact", "steps", "enforcement", "penalty", "far_radius",
    "scheme", "rho", "mass",
)  # fmt: skip
ERROR_COLUMNS = {
    "peak_force": "peak_force_error",
    "duration": "duration_error",
    "restitution": "restitution_error",
    "history": "history_error",
}
WORK_COLUMNS = {
    "operations": "operations",
    "degrees_of_freedom": "degrees_of_freedom",
    "factorizations": "factorizations",
    "solves": "solves",
    "marches": "marches",
    "steps": "steps_taken",
    "contact_problems": "contact_problems",
    "iterations": "iterations",
}


def finite_elements(points: Iterable[Point]) -> tuple[Point, ...]:
    """The finite-element points that have an answer."""
    return tuple(point for point in points if point.method == "fe" and not point.failure)


def front(points: Iterable[Point], cost: Measure, merit: Measure) -> tuple[Point, ...]:
    """Points than which none is at once cheaper and better, the cheapest first."""
    best, found = np.inf, []
    for point in sorted(points, key=lambda p: (cost(p), merit(p))):
        if merit(point) < best:
            best = merit(point)
            found.append(point)
    return tuple(found)


def excess(point: Point, points: Iterable[Point], merit: Measure, wanted: float) -> float:
    """Processor time of a point over the least of those whose merit is at most ``wanted``; nan if there is none."""
    equals = [other.cpu for other in points if merit(other) <= wanted]
    return point.cpu / min(equals) if equals else np.nan


def verdict(points: Iterable[Point]) -> tuple[str, ...]:
    """A sentence a default: what it costs beside the cheapest setting that does as well; whether bars cover."""
    tried, known = finite_elements(points), known_to(points)
    sentences = [_sentence(point, tried) for point in tried if point.default_for is not None]
    return (*sentences, *([f"the reference is known to {known:.1g}"] if known else []), _covered(tried, known))


def known_to(points: Iterable[Point]) -> float:
    """The bar of the reference that errors are measured from; 0 where that is exact."""
    return max((point.bar or 0.0 for point in points if point.method == REFERENCE), default=0.0)


def _covered(tried: tuple[Point, ...], known: float) -> str:
    """Of the settings that claim anything: a bar beyond every accepted tolerance says that nothing is known."""
    claiming = [point for point in tried if (point.bar or 0.0) <= WIDEST]
    covered = sum(point.error <= (point.bar or 0.0) + known for point in claiming)
    said = f"the claimed bar covers the error in {covered} of {len(claiming)} settings"
    silent = len(tried) - len(claiming)
    return f"{said}; {silent} claim nothing below {WIDEST:g}" if silent else said


def _sentence(point: Point, tried: tuple[Point, ...]) -> str:
    assert point.default_for is not None
    start = f"default for {point.default_for:g}: error {point.error:.1g}, bar {point.bar:.1g}"
    if (point.bar or 0.0) > point.default_for:
        return f"{start}; misses the tolerance, so that a run refines it"
    claimed = excess(point, tried, lambda p: p.bar or np.inf, point.default_for)
    true = excess(point, tried, lambda p: p.error, point.error)
    worst = max(claimed, true)
    place = "on" if worst == 1.0 else f"within a factor {NEAR:g} of" if worst <= NEAR else "off"
    return f"{start}; {_times(claimed)} whose bar meets the tolerance, {_times(true)} as accurate: {place} the front"


def _times(factor: float) -> str:
    """Cost beside the least."""
    return "the cheapest" if factor == 1.0 else f"{factor:.2f} times the cheapest"


def write_tradeoff(scene: Scene, points: Sequence[Point], where: Path) -> Table:
    """Write ``tradeoff.csv`` and ``tradeoff.json`` into a folder, made when it is not there; the latter's content."""
    where.mkdir(parents=True, exist_ok=True)
    rows = [
        [
            point.method,
            *(point.settings.get(key) for key in SETTING_COLUMNS),
            point.default_for,
            point.cpu,
            point.error,
            point.bar,
            *(point.errors.get(key) for key in ERROR_COLUMNS),
            *(point.work.get(key) for key in WORK_COLUMNS),
            point.failure or None,
        ]
        for point in points
    ]
    header = ["method", *SETTING_COLUMNS, "default_for", "cpu_s", "error", "bar"]
    header += [*ERROR_COLUMNS.values(), *WORK_COLUMNS.values(), "failure"]
    write_csv(where / "tradeoff.csv", header, rows)
    described = [vars(point) | {"error": point.error} for point in points]
    content = {"schema": SCHEMA, "scene": scene.to_dict(), "verdict": verdict(points), "points": described}
    plain_content: Table = plain(content)
    write_json(where / "tradeoff.json", plain_content)
    return plain_content
