"""Error against cost as files: a row a method in CSV, described with the verdict in JSON."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from fe_contact.studies.tradeoff.front import verdict
from fe_contact.studies.tradeoff.point import Point
from lumped.scene.scene import Scene
from lumped.schema.csv_file import write_csv
from lumped.schema.json_file import plain, write_json

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
    content = {"schema": SCHEMA, "scene": scene.to_dict(), "verdict": verdict(points), "points": described}
    plain_content: dict[str, Any] = plain(content)
    write_json(where / "tradeoff.json", plain_content)
    return plain_content
