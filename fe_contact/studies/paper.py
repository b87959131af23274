"""The study of the paper, written and told: claims, assumptions, misprints and grids in CSV, all of it in JSON."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from fe_contact.studies.files import Line, write_study
from lumped.paper.claims import (
    AGREES,
    DIFFERS,
    UNDECIDED,
    UNJUDGED,
    UNKNOWN,
    UNPRINTED,
    VERDICTS,
    GridRow,
    JudgedClaim,
    PaperStudy,
    counts,
)
from lumped.paper.value import Value
from lumped.result.result import provenance
from lumped.schema import Table

SCHEMA = "fe-contact/paper/1"
TABLES = {  # what is in each, of which columns
    "paper": (
        "claims",
        ("id", "place", "quantity", "unit", "printed", "recomputed", "error", "deviation", "verdict", "rule",
         "recomputed_as", "note"),
    ),
    "assumptions": (
        "assumptions",
        ("id", "example", "assumption", "criterion", "recomputed", "error", "holds_below", "fails_above", "verdict",
         "note"),
    ),
    "misprints": ("misprints", ("number", "place", "printed", "correct", "proof", "kind", "recomputed",
                                "recomputed_as")),
}  # fmt: skip
GRID_QUANTITIES = {
    "peak_force": "peak_force_N",
    "peak_time": "peak_time_s",
    "duration": "duration_s",
    "restitution": "restitution",
}


def write_paper(study: PaperStudy, where: Path) -> Table:
    """Write ``paper.csv``, three more tables and ``paper.json`` into a folder; the content of the last.

    SI units, null where undefined.
    """
    content: Table = {
        "schema": SCHEMA,
        "name": study.examples.name,
        "counts": counts(study.claims),
        "claims": [_claim(one) for one in study.claims],
        "assumptions": [
            _numbers(one.values) | asdict(one.assumption) | {"verdict": one.verdict} for one in study.assumptions
        ],
        "misprints": [_numbers(values) | asdict(misprint) for misprint, values in study.misprints],
        "grid": [_grid_row(row) for row in study.grid],
        "examples": study.examples,
        "provenance": provenance(),
    }
    lines = {name: [_line(row, columns) for row in content[key]] for name, (key, columns) in TABLES.items()}
    return write_study(where, "paper", content, {**lines, "grid": content["grid"]})


def _claim(one: JudgedClaim) -> Table:
    claim = {name: value for name, value in vars(one.claim).items() if name != "rule"}
    judged = {"deviation": one.deviation, "verdict": one.verdict, "rule": one.claim.rule.name}
    return claim | _numbers(one.values) | judged


def _numbers(values: Sequence[Value]) -> dict[str, list[float]]:
    return {"recomputed": [value.value for value in values], "error": [value.error for value in values]}


def _grid_row(row: GridRow) -> Table:
    found: Table = {"figure": row.figure, "panel": "abcd"[row.panel], "R1": row.R1, "R2_s": row.R2}
    for result in (row.clipped, row.exact):
        found |= {f"{result.method}_{name}": result.quantities[key].value for key, name in GRID_QUANTITIES.items()}
    return found


def _line(row: Table, columns: Sequence[str]) -> Line:
    """Several numbers in one cell are separated as the claims are."""
    cells = {column: row[column] for column in columns}
    return {key: "; ".join(map(repr, cell)) if isinstance(cell, list) else cell for key, cell in cells.items()}


def told(found: PaperStudy) -> list[str]:
    """One line a claim, one an assumption, then the counts."""
    lines = [f"{'claim':14s} {'quantity':54s} {'printed':26s} {'recomputed':30s} {'deviation':>9s}  verdict"]
    lines += [_said(one) for one in found.claims]
    for judged in found.assumptions:
        one = judged.assumption
        lines.append(f"{one.id:17s} {one.assumption}: {one.criterion} {_shown(judged.values)}: {judged.verdict}")
    number = counts(found.claims)
    reasons = ", ".join(f"{count} {name}" for name, count in number.items() if name not in VERDICTS)
    sums = f"{number[AGREES]} agree, {number[DIFFERS]} differ, {number[UNDECIDED]} {UNDECIDED}"
    lines.append(f"{sums}, {number[UNKNOWN]} {UNKNOWN} ({reasons})")
    lines.append(f"{number[UNPRINTED]} numbers beside them with {UNPRINTED}")
    return lines


def _said(one: JudgedClaim) -> str:
    claim, share = one.claim, "" if one.deviation is None else f"{round(100.0 * one.deviation, 2) + 0.0:+.2f} %"
    printed = f"{claim.printed} {claim.unit}" if claim.printed and claim.unit != "1" else claim.printed
    values, verdict = _shown(one.values), one.verdict
    if claim.rule.kind in UNJUDGED:  # the value is not the claimed quantity
        reason = f" ({claim.rule.name})" if verdict == UNKNOWN else ""
        beside = ": ".join(part for part in (claim.recomputed_as, values) if part)
        values, verdict = "", "; ".join(part for part in (verdict + reason, beside) if part)
    return f"{claim.id:14s} {claim.quantity:54s} {printed:26s} {values:30s} {share:>9s}  {verdict}"


def _shown(values: Sequence[Value]) -> str:
    return "; ".join(f"{value.value:.5g}" for value in values)
