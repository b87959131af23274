"""What ``fe-contact restitution`` writes: a row an impact as CSV, a line a formula as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from fe_contact.studies.restitution.table import RestitutionLine
from lumped.schema.csv_file import write_csv
from lumped.schema.json_file import plain, write_json

SCHEMA = "fe-contact/restitution/1"
COLUMNS = ("law", "damping", "exit", "asked", "obtained", "difference")


def write_restitution(lines: Sequence[RestitutionLine], where: Path) -> dict[str, Any]:
    """Write ``restitution.csv`` and ``restitution.json`` into a folder; the content of the latter."""
    where.mkdir(parents=True, exist_ok=True)
    rows = [
        [line.law, line.damping, line.exit, e, got, None if got is None else got - e]
        for line in lines
        for e, got in zip(line.asked, line.obtained, strict=True)
    ]
    write_csv(where / "restitution.csv", COLUMNS, rows)
    described = [{**line._asdict(), "worst": _worst(line)} for line in lines]
    content: dict[str, Any] = plain({"schema": SCHEMA, "lines": described})
    write_json(where / "restitution.json", content)
    return content


def _worst(line: RestitutionLine) -> dict[str, float] | None:
    worst = line.worst
    return None if worst is None else {"difference": worst[0], "asked": worst[1]}
