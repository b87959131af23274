"""The page: one HTML file with everything in it, from ``report.html``, ``report.css`` and ``report.js`` beside this.

Figures are the SVG files of the studies, their names of parts made unlike each other's; tables are the CSV files, as
they are. Nothing is loaded from anywhere, and nothing tells when or where the page was made.
"""

from __future__ import annotations

import csv
import json
import math
import re
from collections.abc import Iterator, Sequence
from html import escape
from pathlib import Path
from typing import NamedTuple

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from fe_contact import __version__
from fe_contact.studies.validate.base import FOLDER, NOTHING_MEASURED, Chapter, Column, Figure, Listing, Report

HERE = Path(__file__).parent
LARGE, SMALL = 1e5, 1e-3  # look: numbers beyond are written with a power of ten
DIGITS, MOST_DIGITS = 4, 7  # look: of a number without a bar, and of one with it at most
PLACES = 2  # look: decimals of a point that are kept of coordinates
WORDS = {"True": "yes", "False": "no"}
NO_UNIT = "unit", "1"  # a column and what stands there, which is not printed
SEVERAL = "; "  # between the numbers of a cell
ONE_LINE, LONG_CELL = 34, ' class="long"'  # look: characters of a cell that is not broken
WIDTH, HEIGHT, EDGE = 120.0, 36.0, 2.0  # look: of a small curve
OF_ROOT = re.compile(r"<svg\b[^>]*>")
BEFORE = re.compile(r"^.*?(?=<svg\b)", re.DOTALL)
BESIDE = re.compile(r"<metadata>.*?</metadata>|<style[^>]*>.*?</style>|<!--.*?-->", re.DOTALL)
GROUND = 'style="fill: #ffffff"'
COORDINATES = re.compile(r'(?<= d=")[^"]+|(?<= [xy]=")[^"]+')
LONG_NUMBER = re.compile(rf"-?\d+\.\d{{{PLACES + 1},}}")
NAMES = (re.compile(r'(?<=\bid=")'), re.compile(r'(?<=href="#)'), re.compile(r"(?<=url\(#)"))


class Cell(NamedTuple):
    """What a cell shows, and its attributes: how it looks, and by which number it is sorted."""

    text: str
    look: str = ""


class Spark(NamedTuple):
    """A small curve of a scene, as the path of an SVG."""

    scene: str
    path: str


def page(report: Report) -> str:
    """The HTML of a report whose sections are written in its folder."""
    environment = Environment(
        loader=FileSystemLoader(HERE), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.globals |= {
        "made_by": report.command_of,
        "figure": lambda told, one: figure(report.folder / FOLDER / told.name, told, one),
        "rows": lambda told, one: list(rows(report.folder / FOLDER / told.name / one.table, one)),
        "histories": lambda told: _histories(report.folder / FOLDER / told.name / told.section.histories),
        "sparks": lambda told: list(sparks(report.folder / FOLDER / told.name / told.section.histories)),
        "text": lambda name: (HERE / name).read_text(encoding="utf-8"),
    }
    template = environment.get_template("report.html")
    return template.render(report=report, version=__version__, folder=FOLDER, nothing_measured=NOTHING_MEASURED)


def figure(where: Path, told: Chapter, one: Figure) -> str:
    """The SVG of a figure as a part of the page."""
    return inlined((where / f"{one.name}.svg").read_text(encoding="utf-8"), f"{told.name}-{one.name}", one.caption)


def inlined(svg: str, name: str, caption: str) -> str:
    """An SVG file without what a page does not need: its names begin with `name`, its ground is the page's.

    Coordinates are rounded to a hundredth of a point, its width is left to the page, its text is the page's to read.
    """
    body = BESIDE.sub("", BEFORE.sub("", svg))
    (box,) = re.findall(r'viewBox="([^"]+)"', OF_ROOT.findall(body)[0])
    label = escape(caption)
    width = float(box.split()[2])
    root = f'<svg viewBox="{box}" role="img" aria-label="{label}" style="--width: {width:.0f}pt">'
    body = OF_ROOT.sub(lambda _: root, body, count=1)
    body = body.replace(GROUND, 'style="fill: none"')
    for place in NAMES:
        body = place.sub(f"{name}-", body)
    body = COORDINATES.sub(lambda found: LONG_NUMBER.sub(_shorter, found[0]), body)
    return "\n".join(line.strip() for line in body.splitlines() if line.strip())


def _shorter(number: re.Match[str]) -> str:
    return f"{float(number[0]):.{PLACES}f}".rstrip("0").rstrip(".")


def rows(path: Path, listing: Listing) -> Iterator[list[Cell]]:
    """The rows of a CSV file that a listing shows."""
    key, value = listing.only
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if not key or row[key] == value:
                yield [_cell(row, column) for column in listing.columns]


def _cell(row: dict[str, str], column: Column) -> Cell:
    text = WORDS.get(row[column.key], row[column.key])
    text = "" if (column.key, text) == NO_UNIT else text
    value = _number(text)
    if value is None:
        said = SEVERAL.join(_shorter_number(part) for part in text.split(SEVERAL))
        return Cell(said, LONG_CELL) if len(said) > ONE_LINE else Cell(said)
    error = _number(row[column.error]) if column.error else None
    return Cell(written(value, error), f' class="number" data-order="{value!r}"')


def _shorter_number(text: str) -> str:
    """One of several numbers of a cell; what is none stays."""
    value = _number(text)
    return text if value is None or len(text) <= MOST_DIGITS else written(value)


def _number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def written(value: float, error: float | None = None) -> str:
    """A number as a reader wants it, with its bar: 0.16134 ± 0.00019, (1.0500 ± 0.0003)·10¹¹."""
    size = max(abs(value), error or 0.0)
    power = math.floor(math.log10(size)) if size and not SMALL <= size < LARGE else 0
    value, error = value / 10.0**power, None if error is None else error / 10.0**power
    if not error:
        said = f"{value:.{DIGITS}g}"
    else:
        places = min(max(0, 1 - math.floor(math.log10(error))), MOST_DIGITS)
        said = (
            f"{value:.{places}f} ± {error:.{places}f}"
            if error >= 0.5 * 10.0**-places
            else f"{value:.{places}f} ± {error:.0e}"
        )
    said = said.replace("-", "−")
    if not power:
        return said
    raised = str(power).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"({said})·10{raised}" if error else f"{said}·10{raised}"


def _histories(path: Path) -> str:
    """Force histories as JSON within a script."""
    return path.read_text(encoding="utf-8").replace("<", "\\u003c")


def sparks(path: Path) -> Iterator[Spark]:
    """Of every scene its first curve."""
    for scene, content in json.loads(path.read_text(encoding="utf-8")).items():
        first = next(iter(content["curves"].values()))
        yield Spark(scene, spark(first["time"], first["force"]))


def spark(time: Sequence[float], force: Sequence[float]) -> str:
    """The path of a curve in a small box."""
    low, high = min(0.0, *force), max(force)
    across = (WIDTH - 2.0 * EDGE) / (time[-1] - time[0])
    up = (HEIGHT - 2.0 * EDGE) / ((high - low) or 1.0)
    points = [
        f"{EDGE + across * (t - time[0]):.1f} {HEIGHT - EDGE - up * (f - low):.1f}"
        for t, f in zip(time, force, strict=True)
    ]
    return "M" + "L".join(points)
