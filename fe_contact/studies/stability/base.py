"""What every study shares: a case, its row, and how a map of rows is drawn.

What ``fe-contact stability`` measures and writes: a CSV a study and one JSON.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from fe_contact.progress import Progress
from fe_contact.settings import Given
from fe_contact.studies import journal
from lumped.errors import NotReached
from lumped.schema import Table
from lumped.schema.csv_file import write_csv
from lumped.schema.json_file import plain, write_json
from lumped.schema.members import Folder

Case = Given
Row = Given
SCHEMA = "fe-contact/stability/1"
KEPT = "stability.jsonl"


@dataclass(frozen=True)
class Measure:
    """A number of every row: what it is called on the chart, and how large it may be."""

    label: str
    limit: float


@dataclass(frozen=True)
class Chart:
    """Settings that name a map's rows and its columns, and the measures it shows, one panel each."""

    rows: tuple[str, ...]
    columns: tuple[str, ...]
    measures: Mapping[str, Measure]


@dataclass(frozen=True)
class MethodStudy:
    """Its ``title``; ``cases(quick)``: settings, each a flat table; ``measure(case)``: the numbers of one case, which
    may raise a named failure: that is a finding, not a crash; ``chart``: how its map is drawn.
    """

    title: str
    cases: Callable[[bool], list[Case]]
    measure: Callable[[Case], Table]
    chart: Chart


STUDIES = Folder[MethodStudy]("fe_contact.studies.stability")


def row(study: str, case: Case) -> Row:
    """The case with its numbers, or with the name of its failure."""
    try:
        numbers: Row = plain(STUDIES.get(study).measure(case))
        return {"study": study, **case, **numbers, "failure": ""}
    except NotReached as failure:
        return {"study": study, **case, "failure": type(failure).__name__}


def rows_of(quick: bool, jobs: int, where: Path, progress: Progress) -> list[Row]:
    """Every row of every study, by so many processes; rows are kept in the folder `where`."""
    asked = [(study, case) for study in STUDIES.names for case in STUDIES.get(study).cases(quick)]
    calls = {f"case {place} of {len(asked)}: {one[0]}": partial(row, *one) for place, one in enumerate(asked, start=1)}
    return list(journal.rows(where / KEPT, calls, progress, jobs).values())


def write_stability(rows: Sequence[Row], where: Path) -> Table:
    """Write ``<study>.csv`` and ``stability.json`` into a folder; the content of the latter."""
    for study in STUDIES.names:
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
