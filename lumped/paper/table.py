"""Reading a table of the packaged paper data: a CSV file whose cells are texts."""

from __future__ import annotations

import csv

from lumped.errors import BadInput, Fault
from lumped.schema.files import data_folder


def rows(name: str, columns: tuple[str, ...]) -> list[dict[str, str]]:
    """The rows of `data/paper/<name>` by column. Raises BadInput for another header, or a row of another length."""
    path = data_folder() / "paper" / name
    with path.open(newline="", encoding="utf-8") as file:
        header, *body = list(csv.reader(file))
    if tuple(header) != columns:
        raise BadInput(Fault(name, "header", f"{','.join(header)}; accepted: {','.join(columns)}"))
    wrong = [line for line, row in enumerate(body, start=2) if len(row) != len(columns)]
    if wrong:
        raise BadInput(Fault(name, f"line {line}", f"accepted: {len(columns)} cells") for line in wrong)
    return [dict(zip(columns, row, strict=True)) for row in body]
