"""A measured curve from a CSV file, as loggers write it: units by the header, semicolons or spaces, decimal commas.

The header is the first line that names a time and a force: `time_s,force_N`, `t [ms];F [kN]`, `Zeit/ms`, `Force (N)`;
units may stand in a line of their own below, and other columns beside. What had to be guessed is said in the curve's
remarks.
"""

from __future__ import annotations

import codecs
import csv
import math
import re
from array import array
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from lumped.errors import BadInput, Fault, shown
from lumped.numbers import Array
from lumped.result.score import Curve
from lumped.schema.csv_file import FILE, MOST_BYTES, MOST_ROWS
from lumped.schema.files import content

SPACES = " "  # one or more
SEPARATORS = ("\t", ";", ",", SPACES)  # the first that tells a time from a force
BLANK = ' \t,;"#'  # what a line without a cell consists of
PREAMBLE = 40  # work: lines in which a header is looked for
WORD = re.compile(r"[^\W_]+")
ACCELERATION = re.compile(r"\b(acc|acceleration|beschleunigung)(?![^\W_])|\ba *[\[(/_] *(g|m/s)", re.IGNORECASE)


@dataclass(frozen=True)
class Dimension:
    """What a column holds: its name in SI, the words loggers call it by, and SI per unit."""

    plain: str
    names: frozenset[str]
    units: Mapping[str, float]

    def place(self, cells: Sequence[str]) -> ColumnOfCurve | None:
        """The column that a header calls so, by its name, or by a unit that no other has. Raises ValueError of two."""
        found = [self._read(place, cell) for place, cell in enumerate(cells)]
        plain = [column for column in found if column.header == self.plain]
        if called := plain or [column for column in found if column.name in self.names]:
            return called[0]
        measured = [column for column in found if column.unit]
        if len(measured) > 1:
            raise ValueError(", ".join(column.header for column in measured))
        return measured[0] if measured else None

    def unit_of(self, factor: float) -> str:
        """The plainest name of the unit of which one is so much in SI; empty where no file has it."""
        return next((name for name, one in self.units.items() if math.isclose(one, factor) and name.isascii()), "")

    def _read(self, place: int, cell: str) -> ColumnOfCurve:
        words = WORD.findall(cell)
        unit = next((known for known in self.units if words and words[-1] == known), "")
        name = " ".join(words[:-1] if unit and len(words) > 1 else words).lower()
        return ColumnOfCurve(place, cell.strip(" #"), name, unit, self.units.get(unit, 1.0))


class ColumnOfCurve(NamedTuple):
    """Where a column stands, its header, the name and unit in that, and SI per unit."""

    place: int
    header: str
    name: str
    unit: str
    factor: float


TIME = Dimension(
    "time_s",
    frozenset(("time", "t", "zeit", "temps", "tiempo", "tempo")),
    {"s": 1.0, "sec": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "μs": 1e-6, "ns": 1e-9},
)
FORCE = Dimension(
    "force_N",
    frozenset(("force", "f", "load", "kraft", "contact force", "impact force")),
    {
        "N": 1.0,
        "kN": 1e3,
        "mN": 1e-3,
        "MN": 1e6,
        "µN": 1e-6,
        "μN": 1e-6,
        "uN": 1e-6,
        "kgf": 9.80665,
        "lbf": 4.4482216,
        "kip": 4448.2216,
    },
)


@dataclass(frozen=True)
class CurveHeader:
    """The columns of time and force, how many there are, the separator, and the lines up to the first of numbers."""

    time: ColumnOfCurve
    force: ColumnOfCurve
    columns: int
    separator: str
    lines: int

    @property
    def units(self) -> tuple[str, str]:
        """Those of time and force; SI where none is named."""
        return self.time.unit or "s", self.force.unit or "N"

    @property
    def remarks(self) -> Iterator[str]:
        """What is not as `time_s,force_N` has it."""
        for dimension, column in ((TIME, self.time), (FORCE, self.force)):
            if column.header != dimension.plain:
                unit = column.unit or f"no unit, so {WORD.findall(dimension.plain)[-1]}"
                yield f"{column.header} is read as the {dimension.plain.partition('_')[0]}, in {unit}"


def read_curve(path: Path) -> Curve:
    """A measured curve: a CSV file with a time and a force at least. Raises BadInput."""
    source = str(path)
    try:
        lines = _text(content(path, MOST_BYTES, FILE)).splitlines()
        header = _header(source, lines)
        time, force, commas = _numbers(source, lines, header)
    except (UnicodeDecodeError, csv.Error) as error:
        reason = f"cannot be read: no CSV text; accepted: {FILE}; cure: export it as CSV in UTF-8"
        raise BadInput(Fault(source, "", reason)) from error
    if time.size < 2:
        raise BadInput(Fault(source, header.force.header, "accepted: at least two rows of numbers"))
    if np.any(back := np.diff(time) < 0.0):
        reason = f"decreases after row {int(np.argmax(back)) + 1}; accepted: times in order; cure: sort the rows"
        raise BadInput(Fault(source, header.time.header, reason))
    if not time[-1] > time[0]:
        raise BadInput(Fault(source, header.time.header, f"every row is at {time[0]:g} s; accepted: times that grow"))
    if force.max() <= 0.0:
        cure = "multiply it by -1" if force.min() < 0.0 else "a column in which the bodies press"
        reason = f"never above zero; accepted: compression positive; cure: {cure}"
        raise BadInput(Fault(source, header.force.header, reason))
    separated = {";": "semicolons separate the columns", SPACES: "spaces separate the columns"}.get(
        header.separator, ""
    )
    told = (*header.remarks, separated, "commas are decimal" if commas else "")
    return Curve(time, force, tuple(filter(None, told)), header.units)


def _text(content: bytes) -> str:
    """UTF-8, or UTF-16 where a mark says so, or what Windows writes in the west. Raises UnicodeDecodeError."""
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return content.decode("utf-16")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("cp1252")


def _header(source: str, lines: Sequence[str]) -> CurveHeader:
    """The first line that names a time and a force, the units perhaps in the next. Raises BadInput."""
    nearest, lacking, sentence = "", [TIME, FORCE], ""
    for number, line in enumerate(lines[:PREAMBLE]):
        if line.startswith("sep="):  # of Excel, for itself
            continue
        nearest = nearest or line.strip()
        for separator in SEPARATORS:
            cells = _cells(line, separator)
            below = _cells(lines[number + 1], separator) if number + 1 < len(lines) else []
            with_units, more = _with_units(cells, below)
            try:
                time, force = TIME.place(with_units), FORCE.place(with_units)
            except ValueError as several:
                reason = f"{several}: which is meant? cure: call the one {TIME.plain} or {FORCE.plain}"
                raise BadInput(Fault(source, "", reason)) from None
            if time and force and time.place != force.place:
                first = _cells(lines[number + 1 + more], separator) if number + 1 + more < len(lines) else []
                if separator == SPACES and not (len(first) == len(cells) and all(map(_is_number, first))):
                    sentence = sentence or " ".join(with_units)  # or names of several words, as "F (N)"
                    continue
                return CurveHeader(time, force, len(cells), separator, number + 1 + more)
            missing = [one for one, there in ((TIME, time), (FORCE, force)) if not there]
            if 0 < len(missing) < len(lacking):
                nearest, lacking = separator.join(with_units), missing
    if sentence and sentence == " ".join(nearest.lstrip("# ").split()):
        reason = f"the header {shown(sentence)} has not as many words as the row below has numbers"
        raise BadInput(Fault(source, "", f"{reason}; cure: one word a column, as time_ms force_N, or commas between"))
    header = f"with a header of {shown(nearest)}" if nearest else "of a file without a line"
    said = f"missing column, {header}; accepted: time_s,force_N, or t [ms];F [kN] and the like"
    units = {one.plain: ", ".join(filter(str.isascii, one.units)) for one in lacking}
    cure = ""
    if ACCELERATION.search(nearest):
        cure = "; cure: a column of the force, mass times acceleration"
    elif nearest and all(map(_is_number, filter(None, re.split(r"[\s;,]+", nearest)))):
        cure = "; cure: a first line that names the columns, as time_s,force_N"
    raise BadInput(Fault(source, name, f"{said}, in {known}{cure}") for name, known in units.items())


def _cells(line: str, separator: str) -> list[str]:
    return [cell.strip() for cell in next(_rows([line], separator), [])]


def _rows(lines: Sequence[str], separator: str) -> Iterator[list[str]]:
    if separator == SPACES:
        return (line.lstrip("# ").split() for line in lines)
    return csv.reader(lines, delimiter=separator)


def _with_units(cells: list[str], below: list[str]) -> tuple[list[str], int]:
    """Header cells together with a line of units below them; how many lines that is."""
    known = {*TIME.units, *FORCE.units}
    if len(below) != len(cells) or not any(set(WORD.findall(cell)) & known for cell in below):
        return cells, 0
    if any(_is_number(cell) for cell in below):
        return cells, 0
    return [f"{name} [{unit.strip('[]()')}]" for name, unit in zip(cells, below, strict=True)], 1


def _is_number(cell: str) -> bool:
    try:
        return math.isfinite(_number(cell))
    except ValueError:
        return False


def _number(cell: str) -> float:
    """A number with a decimal point, or with a comma: of both kinds of marks the last is the decimal one."""
    try:
        return float(cell)
    except ValueError:
        if cell.rfind(",") > cell.rfind("."):
            return float(cell.replace(".", "").replace(",", "."))
        return float(cell.replace(",", ""))


def _numbers(source: str, lines: Sequence[str], header: CurveHeader) -> tuple[Array, Array, bool]:
    """Times, s, forces, N, and whether their commas are decimal. Raises BadInput."""
    below = lines[header.lines :]
    if sum(bool(line.strip(BLANK)) for line in below) > MOST_ROWS:
        told = f"more than {MOST_ROWS} rows; accepted: fewer, as every tenth"
        raise BadInput(Fault(source, f"{header.time.header},{header.force.header}", told))
    rows = (row for row in _rows(below, header.separator) if any(map(str.strip, row)))
    columns, missing, commas = (array("d"), array("d")), list[int](), False
    for number, row in enumerate(rows, start=1):
        if header.separator == "," and number == 1 and len(row) == 2 * header.columns:
            reason = "commas separate the columns and the decimals too; cure: export with semicolons or decimal points"
            raise BadInput(Fault(source, f"row {number}", reason))
        cells = [row[one.place].strip() if one.place < len(row) else "" for one in (header.time, header.force)]
        if any(cell.lower() in ("", "nan", "na", "null") for cell in cells):
            missing.append(number)
            continue
        for column, one, cell in zip(columns, (header.time, header.force), cells, strict=True):
            column.append(_finite(source, number, one, cell))
            commas = commas or "," in cell
    if missing:
        reason = f"{len(missing)} samples are missing, the first in row {missing[0]}; accepted: every value finite"
        raise BadInput(Fault(source, header.force.header, f"{reason}; cure: export the record again, or cut it there"))
    time, force = (np.array(column) for column in columns)
    return time * header.time.factor, force * header.force.factor, commas


def _finite(source: str, number: int, column: ColumnOfCurve, cell: str) -> float:
    """The finite number in a row. Raises BadInput."""
    try:
        if math.isfinite(value := _number(cell)):
            return value
    except ValueError:
        pass
    reason = f"row {number} holds no number in this column, but {shown(cell)}; accepted: as 1.5e-3"
    raise BadInput(Fault(source, column.header, reason))
