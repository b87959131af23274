"""What ``fe-contact stability`` measures and writes: a CSV a study and one JSON."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from fe_contact.progress import Progress
from fe_contact.studies import journal
from fe_contact.studies.stability.base import STUDIES, Row, row
from lumped.schema.csv_file import write_csv
from lumped.schema.json_file import write_json
from lumped.schema.members import available, get

SCHEMA = "fe-contact/stability/1"
KEPT = "stability.jsonl"


def rows_of(quick: bool, jobs: int, where: Path, progress: Progress) -> list[Row]:
    """Every row of every study, by so many processes; rows are kept in the folder `where`."""
    asked = [(study, case) for study in available(STUDIES) for case in get(STUDIES, study).cases(quick)]
    calls = {f"case {place} of {len(asked)}: {one[0]}": partial(row, *one) for place, one in enumerate(asked, start=1)}
    return list(journal.rows(where / KEPT, calls, progress, jobs).values())


def write_stability(rows: Sequence[Row], where: Path) -> dict[str, Any]:
    """Write ``<study>.csv`` and ``stability.json`` into a folder; the content of the latter."""
    for study in available(STUDIES):
        own = [found for found in rows if found["study"] == study]
        header = list(dict.fromkeys(key for found in own for key in found if key != "study"))
        write_csv(where / f"{study}.csv", header, [[found.get(key) for key in header] for found in own])
    content = {
        "schema": SCHEMA,
        "cases": len(rows),
        "steps": sum(found.get("steps") or 0 for found in rows),
        "iterations": sum(found.get("iterations") or 0 for found in rows),
        "failures": dict(Counter(found["failure"] for found in rows if found["failure"])),
        "rows": list(rows),
    }
    write_json(where / "stability.json", content)
    return content
