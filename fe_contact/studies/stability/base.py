"""What every study shares: a case, its row, and how a map of rows is drawn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from lumped.errors import NotReached
from lumped.schema.json_file import plain
from lumped.schema.members import get

STUDIES = "fe_contact.studies.stability"
Case = Mapping[str, Any]
Row = Mapping[str, Any]


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


def row(study: str, case: Case) -> Row:
    """The case with its numbers, or with the name of its failure."""
    try:
        numbers: Row = plain(get(STUDIES, study).measure(case))
        return {"study": study, **case, **numbers, "failure": ""}
    except NotReached as failure:
        return {"study": study, **case, "failure": type(failure).__name__}
