"""CSV files with a header: columns of numbers, read and written with every digit, and rows of anything."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lumped.errors import BadInput, Fault

Array = NDArray[np.float64]


def write_csv(path: Path, header: Sequence[str], rows: Iterable[Sequence[Any]]) -> None:
    """Rows of numbers and texts; a cell whose value is undefined or not finite is empty."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows([_cell(value) for value in row] for row in rows)


def write_columns(path: Path, header: Sequence[str], columns: Sequence[Array]) -> None:
    """Columns of numbers, each (rows,)."""
    table = np.column_stack(columns)
    np.savetxt(path, table, fmt="%.17g", delimiter=",", header=",".join(header), comments="")


def read_columns(path: Path, wanted: tuple[str, ...]) -> dict[str, Array]:
    """The `wanted` columns of a file, which may hold more, each of shape (rows,). Raises BadInput."""
    source = str(path)
    try:
        with path.open(newline="", encoding="utf-8") as file:
            rows = [row for row in csv.reader(file) if any(cell.strip() for cell in row)]
    except OSError as error:
        raise BadInput(Fault(source, "", f"cannot be read: {error.strerror or error}")) from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise BadInput(Fault(source, "", "cannot be read: no CSV text")) from error
    header = [cell.strip() for cell in rows[0]] if rows else []
    missing = [name for name in wanted if name not in header]
    if missing:
        raise BadInput(Fault(source, name, f"missing column; accepted header: {','.join(wanted)}") for name in missing)
    return {name: _column(source, name, rows, header.index(name)) for name in wanted}


def _column(source: str, name: str, rows: list[list[str]], index: int) -> Array:
    try:
        column = np.array([float(row[index]) for row in rows[1:]])
    except (ValueError, IndexError) as error:
        raise BadInput(Fault(source, name, "a row holds no number in this column")) from error
    if column.size < 2 or not np.all(np.isfinite(column)):
        raise BadInput(Fault(source, name, "accepted: at least two rows, every value finite"))
    return column


def _cell(value: Any) -> str:
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return ""
    return repr(float(value)) if isinstance(value, float) else str(value)
