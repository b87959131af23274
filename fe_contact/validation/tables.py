"""Judgements and trade-offs as files: CSV for a spreadsheet, JSON for a script, both without NaN."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from fe_contact.validation.compare import Comparison
from fe_contact.validation.front import verdict
from fe_contact.validation.tradeoff import Point
from fe_contact.validation.verdict import verdicts
from lumped.scene import Scene

COMPARE_SCHEMA = "fe-contact/compare/1"
TRADEOFF_SCHEMA = "fe-contact/tradeoff/1"
SCORE_COLUMNS = {
    "peak_force": "peak_force_error",
    "peak_time": "peak_time_error",
    "peak_depth": "peak_depth_error",
    "duration": "duration_error",
    "restitution": "restitution_error",
    "impulse": "impulse_error",
    "work": "work_error",
    "loss": "loss_error",
    "shape": "shape_error",
    "peak_shift": "peak_shift_error",
    "contact_radius_rebound": "contact_radius_rebound_error",
    "pressure_rebound": "pressure_rebound_error",
    "held_until_max_depth": "held_until_max_depth_error",
}
SETTING_COLUMNS = (
    "tolerance", "elements", "order", "elements_per_contact", "steps", "enforcement", "penalty", "far_radius"
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


def write_comparison(comparison: Comparison, where: Path) -> dict[str, Any]:
    """Write every history, ``scores.csv`` and ``compare.json`` into a folder; the content of the latter."""
    comparison.reference.write(where)
    for name, law in comparison.laws.items():
        law.history.write_csv(where / f"{name}-history.csv")
    nested = comparison.nested and comparison.nested.holds  # of the reference: the same in every row
    rows = [[j.name, j.score_percent, *(j.errors[key] for key in SCORE_COLUMNS), nested] for j in comparison.judgements]
    write_csv(where / "scores.csv", ["law", "score_percent", *SCORE_COLUMNS.values(), "nested_areas"], rows)
    content = comparison_content(comparison)
    write_json(where / "compare.json", content)
    return content


def comparison_content(comparison: Comparison) -> dict[str, Any]:
    """The content of ``compare.json``: verdict, errors, and what the error bars leave open of each."""
    reference = comparison.reference
    content: dict[str, Any] = plain(
        {
            "schema": COMPARE_SCHEMA,
            "scene": reference.scene.name,
            "tolerance": reference.tolerance,
            "converged": reference.converged,
            "verdict": verdicts(comparison),
            "reference": {name: vars(quantity) for name, quantity in reference.quantities.items()},
            "candidates": {
                j.name: {"score_percent": j.score_percent, "errors": j.errors, "bars": j.bars}
                for j in comparison.judgements
            },
            "nested_areas": comparison.nested and vars(comparison.nested) | {"holds": comparison.nested.holds},
            "refused": comparison.refused,
        }
    )
    return content


def write_tradeoff(scene: Scene, points: Sequence[Point], where: Path) -> dict[str, Any]:
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
    content = {"schema": TRADEOFF_SCHEMA, "scene": scene.to_dict(), "verdict": verdict(points), "points": described}
    plain_content: dict[str, Any] = plain(content)
    write_json(where / "tradeoff.json", plain_content)
    return plain_content


def write_csv(path: Path, header: Sequence[str], rows: Iterable[Sequence[Any]]) -> None:
    """A CSV file with every digit; what is undefined is empty."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows([_cell(value) for value in row] for row in rows)


def write_json(path: Path, content: Mapping[str, Any]) -> None:
    """An indented JSON file."""
    text = json.dumps(content, indent=2, allow_nan=False, ensure_ascii=False)
    path.write_text(text + "\n", encoding="utf-8")


def plain(value: Any) -> Any:
    """Lists, dictionaries and numbers only; what is not finite is None."""
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    return value


def _cell(value: Any) -> str:
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return ""
    return repr(float(value)) if isinstance(value, float) else str(value)
