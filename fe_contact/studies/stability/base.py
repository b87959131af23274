"""Where methods break: what every study of it is, its cases, how a map of them is drawn.

What ``fe-contact stability`` measures, writes, a CSV a study and one JSON, and says.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path

from fe_contact.progress import Progress
from fe_contact.settings import Given
from fe_contact.studies import journal
from fe_contact.studies.files import write_study
from lumped.errors import NotReached
from lumped.schema import Table
from lumped.schema.json_file import plain
from lumped.schema.members import Folder

SCHEMA = "fe-contact/stability/1"
KEPT = "stability.jsonl"
Case = Given
Row = Given


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


FAMILIES = Folder[Mapping[str, MethodStudy]]("fe_contact.studies.stability")


@cache
def studies() -> dict[str, MethodStudy]:
    """Every study by the name of its file, sorted."""
    found = {name: study for family in FAMILIES.members.values() for name, study in family.items()}
    return dict(sorted(found.items()))


def row(study: str, case: Case) -> Row:
    """The case with its numbers, or with the name of its failure."""
    try:
        numbers: Row = plain(studies()[study].measure(case))
        return {"study": study, **case, **numbers, "failure": ""}
    except NotReached as failure:
        return {"study": study, **case, "failure": type(failure).__name__}


def rows_of(quick: bool, jobs: int, where: Path, progress: Progress) -> list[Row]:
    """Every row of every study, by so many processes; rows are kept in the folder `where`."""
    asked = [(name, case) for name, study in studies().items() for case in study.cases(quick)]
    calls = {f"case {place} of {len(asked)}: {one[0]}": partial(row, *one) for place, one in enumerate(asked, start=1)}
    return list(journal.rows(where / KEPT, calls, progress, jobs).values())


def write_stability(rows: Sequence[Row], where: Path) -> Table:
    """Write ``<study>.csv`` and ``stability.json`` into a folder; the content of the latter."""
    tables = {
        name: [{key: cell for key, cell in found.items() if key != "study"} for found in rows if found["study"] == name]
        for name in studies()
    }
    content = {
        "schema": SCHEMA,
        "cases": len(rows),
        "steps": sum(found.get("steps") or 0 for found in rows),
        "iterations": sum(found.get("iterations") or 0 for found in rows),
        "failures": Counter(found["failure"] for found in rows if found["failure"]),
        "rows": rows,
    }
    return write_study(where, "stability", content, tables)


def told(rows: Sequence[Row]) -> list[str]:
    """A line a study."""
    counted = Counter(row["study"] for row in rows)
    failed = Counter(row["study"] for row in rows if row["failure"])
    lines = [f"{study:16s} {count} cases, {failed[study]} of them named failures" for study, count in counted.items()]
    kept = [row for row in rows if row.get("all_kept")]
    held = [
        f"{row['scheme']} {row['mass']} tip {row['tip']:.2f} {row['enforcement']}, CFL {row['cfl']:g}" for row in kept
    ]
    return [*lines, f"all limits kept over ten periods: {'; '.join(held) or 'by no scheme'}"]
