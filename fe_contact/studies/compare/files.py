"""A comparison as files: a history a law and its scores in CSV, verdict and errors in JSON."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from fe_contact.studies.compare.study import Comparison
from fe_contact.studies.compare.verdict import verdicts
from lumped.schema.csv_file import write_csv
from lumped.schema.json_file import plain, write_json

SCHEMA = "fe-contact/compare/1"
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


def write_comparison(comparison: Comparison, where: Path) -> None:
    """Write every history, ``scores.csv`` and ``compare.json`` into a folder."""
    comparison.reference.write_files(where)
    for name, law in comparison.laws.items():
        law.history.write_csv(where / f"{name}-history.csv")
    nested = comparison.nested and comparison.nested.holds  # of the reference: the same in every row
    rows = [[j.name, j.score_percent, *(j.errors[key] for key in SCORE_COLUMNS), nested] for j in comparison.judgements]
    write_csv(where / "scores.csv", ["law", "score_percent", *SCORE_COLUMNS.values(), "nested_areas"], rows)
    write_json(where / "compare.json", comparison_content(comparison))


def comparison_content(comparison: Comparison) -> dict[str, Any]:
    """The content of ``compare.json``: verdict, errors, and what the error bars leave open of each."""
    reference = comparison.reference
    content: dict[str, Any] = plain(
        {
            "schema": SCHEMA,
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
