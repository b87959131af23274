"""The study of the paper as files: claims, assumptions, misprints and grids in CSV, all of it in JSON."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from lumped.paper.claims import JudgedClaim, counts
from lumped.paper.examples.value import Value
from lumped.paper.study import GridRow, PaperStudy
from lumped.result.result import provenance
from lumped.schema import Table
from lumped.schema.csv_file import write_csv
from lumped.schema.json_file import plain, write_json

SCHEMA = "fe-contact/paper/1"
CLAIM_COLUMNS = (
    "id", "place", "quantity", "unit", "printed", "recomputed", "error", "deviation", "verdict", "rule",
    "recomputed_as", "note",
)  # fmt: skip
ASSUMPTION_COLUMNS = (
    "id", "example", "assumption", "criterion", "recomputed", "error", "holds_below", "fails_above", "verdict", "note",
)  # fmt: skip
MISPRINT_COLUMNS = ("number", "place", "printed", "correct", "proof", "kind", "recomputed", "recomputed_as")
GRID_QUANTITIES = {
    "peak_force": "peak_force_N",
    "peak_time": "peak_time_s",
    "duration": "duration_s",
    "restitution": "restitution",
}


def write_study(study: PaperStudy, where: Path) -> Table:
    """Write ``paper.csv``, three more tables and ``paper.json`` into a folder, made when it is not there.

    Returns the content of the last.
    """
    where.mkdir(parents=True, exist_ok=True)
    content = study_content(study)
    tables = {
        "paper": (CLAIM_COLUMNS, content["claims"]),
        "assumptions": (ASSUMPTION_COLUMNS, content["assumptions"]),
        "misprints": (MISPRINT_COLUMNS, content["misprints"]),
        "grid": (tuple(content["grid"][0]), content["grid"]),
    }
    for name, (columns, rows) in tables.items():
        write_csv(where / f"{name}.csv", columns, [[_cell(row[column]) for column in columns] for row in rows])
    write_json(where / "paper.json", content)
    return content


def study_content(study: PaperStudy) -> Table:
    """The content of ``paper.json``: plain numbers, null where undefined."""
    content: Table = plain(
        {
            "schema": SCHEMA,
            "name": study.examples.name,
            "counts": counts(study.claims),
            "claims": [_claim(one) for one in study.claims],
            "assumptions": [
                _numbers(one.values) | asdict(one.assumption) | {"verdict": one.verdict} for one in study.assumptions
            ],
            "misprints": [_numbers(values) | asdict(misprint) for misprint, values in study.misprints],
            "grid": [_grid_row(row) for row in study.grid],
            "examples": asdict(study.examples),
            "provenance": provenance(),
        }
    )
    return content


def _claim(one: JudgedClaim) -> Table:
    claim = {name: value for name, value in vars(one.claim).items() if name != "rule"}
    judged = {"deviation": one.deviation, "verdict": one.verdict, "rule": one.claim.rule.name}
    return claim | _numbers(one.values) | judged


def _numbers(values: Sequence[Value]) -> dict[str, list[float]]:
    return {"recomputed": [value.value for value in values], "error": [value.error for value in values]}


def _grid_row(row: GridRow) -> Table:
    found: Table = {"figure": row.figure, "panel": "abcd"[row.panel], "R1": row.R1, "R2_s": row.R2}
    for result in (row.clipped, row.exact):
        own = {f"{result.method}_{name}": result.quantities[key].value for key, name in GRID_QUANTITIES.items()}
        found |= own
    return found


def _cell(value: Any) -> Any:
    """Several numbers in one cell are separated as the claims are."""
    return "; ".join(repr(number) for number in value) if isinstance(value, list) else value
