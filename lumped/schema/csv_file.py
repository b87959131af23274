"""CSV files with a header: columns of numbers, read and written with every digit, and rows of anything."""

from __future__ import annotations

import csv
import io
import math
from array import array
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from lumped.errors import BadInput, Fault, shown
from lumped.numbers import Array
from lumped.schema.files import content

# What a measurement has, and what is read within seconds.
MOST_BYTES, MOST_ROWS = 50_000_000, 1_000_000
FILE = f"a CSV file of at most {MOST_BYTES // 10**6} MB"


def write_csv(path: Path, header: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """Rows of numbers and texts; a cell whose value is undefined or not finite is empty."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows([_cell(value) for value in row] for row in rows)


def write_columns(path: Path, header: Sequence[str], columns: Sequence[Array], digits: int = 17) -> None:
    """Columns of numbers, each (rows,), with so many significant digits: all that they have by default."""
    table = np.column_stack(columns)
    np.savetxt(path, table, fmt=f"%.{digits}g", delimiter=",", header=",".join(header), comments="")


def read_columns(path: Path, wanted: tuple[str, ...], most: int = MOST_ROWS) -> dict[str, Array]:
    """The `wanted` columns of a file, which may hold more, each of shape (rows,), at most `most`. Raises BadInput."""
    source, rows = str(path), _rows(path)
    try:
        header = [cell.strip() for cell in next(rows, [])]
        if missing := [name for name in wanted if name not in header]:
            said = f"missing column; accepted header: {','.join(wanted)}"
            raise BadInput(Fault(source, name, said) for name in missing)
        columns = _columns(source, rows, {name: header.index(name) for name in wanted}, most)
    except (UnicodeDecodeError, csv.Error) as error:
        raise BadInput(Fault(source, "", f"cannot be read: no CSV text in UTF-8; accepted: {FILE}")) from error
    for name, column in columns.items():
        if column.size < 2 or not np.all(np.isfinite(column)):
            raise BadInput(Fault(source, name, "accepted: at least two rows, every value finite"))
    return columns


def read_header(path: Path) -> list[str]:
    """The names of a file's columns. Raises BadInput."""
    try:
        return [cell.strip() for cell in next(_rows(path), [])]
    except (UnicodeDecodeError, csv.Error):
        return []  # who reads the columns says why


def _rows(path: Path) -> Iterator[list[str]]:
    """The rows of a file that are not empty. Raises BadInput."""
    text = io.TextIOWrapper(io.BytesIO(content(path, MOST_BYTES, FILE)), encoding="utf-8-sig", newline="")
    return (row for row in csv.reader(text) if any(cell.strip() for cell in row))


def _columns(source: str, rows: Iterator[list[str]], places: Mapping[str, int], most: int) -> dict[str, Array]:
    """The numbers of the columns in these places. Raises BadInput."""
    found = {name: array("d") for name in places}
    for number, row in enumerate(rows, start=1):
        if number > most:
            raise BadInput(Fault(source, ",".join(places), f"more than {most} rows; accepted: fewer, as every tenth"))
        for name, place in places.items():
            try:
                found[name].append(float(row[place]))
            except (ValueError, IndexError) as error:
                cell = row[place] if place < len(row) else ""
                reason = f"row {number} holds no number in this column, but {shown(cell)}; accepted: as 1.5e-3"
                raise BadInput(Fault(source, name, reason)) from error
    return {name: np.array(column) for name, column in found.items()}


def _cell(value: object) -> str:
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return ""
    return repr(float(value)) if isinstance(value, float) else str(value)
