"""What every study leaves: tables in CSV, or as Parquet, and a record in JSON."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np

from fe_contact.errors import import_of
from lumped.schema import Table
from lumped.schema.csv_file import write_csv
from lumped.schema.json_file import encoded, plain, write_json

Line = Mapping[str, object]  # cells by their columns


def write_study(
    where: Path,
    record: str,
    content: Mapping[str, object],
    tables: Mapping[str, Sequence[Line]],
    headers: Mapping[str, Iterable[str]] | None = None,
) -> Table:
    """Write every table as ``<name>.csv``, and ``<record>.json``, into a folder, made when it is not there.

    A table's header is what its lines hold, in their order, after what `headers` names, lines or none. Returns the
    content of the record, plain: a dataclass in it as a dictionary of its fields.
    """
    where.mkdir(parents=True, exist_ok=True)
    for name, lines in tables.items():
        header = list(dict.fromkeys([*(headers or {}).get(name, ()), *(key for line in lines for key in line)]))
        write_csv(where / f"{name}.csv", header, [[line.get(key) for key in header] for line in lines])
    written: Table = plain(encoded(content))
    write_json(where / f"{record}.json", written)
    return written


def lines_of(columns: Mapping[str, object]) -> list[Line]:
    """A line for every place of the arrays among the columns, shape (n,); anything else stands in all of them."""
    length = max(column.size for column in columns.values() if isinstance(column, np.ndarray))
    filled = [one.tolist() if isinstance(one, np.ndarray) else [one] * length for one in columns.values()]
    return [dict(zip(columns, line, strict=True)) for line in zip(*filled, strict=True)]


def require_parquet() -> None:
    """Raises ExtraMissing, before any work, where no table could be written as Parquet."""
    with import_of("parquet"):
        import pyarrow.parquet  # noqa: F401 - whether it can be


def write_parquet(path: Path, columns: Mapping[str, object]) -> None:
    """A table of columns by their names; NaN is what is undefined. Raises ExtraMissing."""
    with import_of("parquet"):
        import pyarrow
        from pyarrow import parquet
    arrays = [pyarrow.array(column, from_pandas=True) for column in columns.values()]
    parquet.write_table(pyarrow.table(arrays, names=[*columns]), path)
