"""Maps of where methods break: one chart a study, one panel a measure."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm

from fe_contact.settings import Given
from fe_contact.studies import style
from fe_contact.studies.stability.base import Chart, Measure, Row, studies

CELL, LETTER = 0.16, 0.062  # height of a row, width of a letter of its name, in
UPRIGHT = 0.085  # width of a column's name that stands upright, in
TALLEST = 9.0  # panels that are taller together stand beside each other, in
BESIDE, LINE = 0.12, 0.13  # between them; height of a line of their titles, in
RIGHT = 0.985  # their right end, in shares of the width
DECADES = 2.0  # either side of the limit that the colours span
INDENT = 3  # look: characters of a panel's letter before its title
FEW = 4  # columns, in whose cells there is room for numbers
NOT_ASKED = "0.9"
LINES = [
    "Blue: below its limit; red: above it; the more colour the farther, to a hundredth and a hundredfold. Cross: a "
    "named failure, or nothing to tell. Grey: not asked.",
]


def plot_stability(rows: Sequence[Row], where: Path) -> None:
    """Write ``<study>.svg`` and ``.png`` of every study that has rows into the folder ``where``."""
    for study in dict.fromkeys(row["study"] for row in rows):
        _plot(study, [row for row in rows if row["study"] == study], where)


def _plot(study: str, rows: Sequence[Row], where: Path) -> None:
    """The map of one study: as many panels beside each other as would be too tall together."""
    title, chart = studies()[study].title, studies()[study].chart
    names, columns = _labels(rows, chart.rows), _labels(rows, chart.columns)
    count, tall, few = len(chart.measures), CELL * len(names), len(columns) <= FEW
    across = min(math.ceil(count * tall / TALLEST), count)
    down = math.ceil(count / across)
    left = 0.3 + LETTER * max(map(len, names))
    wide = (RIGHT * style.PAGE - left - (across - 1) * BESIDE) / across
    titles = [_wrapped(measure, wide) for measure in chart.measures.values()]
    between = 0.22 + LINE * max(map(len, titles))
    below = 0.3 if few else 0.2 + LETTER * max(map(len, columns))
    every = 1 if few else math.ceil(UPRIGHT * len(columns) / wide)  # as many columns have names as have room
    height, above = down * tall + (down - 1) * between, between - 0.05
    with style.sheet(where, study, title, LINES, height, above=above, below=below) as sheet:
        gaps = {"wspace": BESIDE / wide, "hspace": between / tall}
        panels = sheet.panels(down, across, left / style.PAGE, RIGHT, **gaps)
        for place, (axes, name) in enumerate(zip(panels, chart.measures, strict=False)):
            _panel(axes, _table(rows, chart, names, columns, name), chart.measures[name])
            style.label(axes, "abcdefgh"[place], "\n".join(titles[place]).lstrip())
            axes.set_yticks(range(len(names)), [""] * len(names) if place % across else names, fontsize=5.6)
            last = place + across >= count
            shown = [one if last and not number % every else "" for number, one in enumerate(columns)]
            axes.set_xticks(range(len(columns)), shown, rotation=0 if few else 90, fontsize=5.6)
        for axes in panels[count:]:
            axes.set_axis_off()


def _wrapped(measure: Measure, width: float) -> list[str]:
    """A panel's title in lines of this width, in, with room for the panel's letter."""
    return textwrap.wrap(f"{measure.label}, limit {measure.limit:g}", int(width / LETTER), initial_indent=" " * INDENT)


def _panel(axes: Axes, table: Mapping[tuple[int, int], float | None], measure: Measure) -> None:
    """Colours by the decades from the limit; a cross where there is no number, a number where there is room."""
    shape = tuple(1 + max(place[axis] for place in table) for axis in (0, 1))
    colours = np.full(shape, np.nan)
    for place, value in table.items():
        if value is None:
            axes.plot(place[1], place[0], marker="x", markersize=3.5, color=style.BLACK, markeredgewidth=0.7)
        else:
            size = max(abs(value), measure.limit * 10.0**-DECADES)
            colours[place] = min(math.log10(size / measure.limit), DECADES)
            if shape[1] <= FEW:
                dark = abs(colours[place]) > DECADES / 2
                colour = "white" if dark else style.BLACK
                axes.text(place[1], place[0], f"{value:.2g}", fontsize=5.0, color=colour, ha="center", va="center")
    axes.set_facecolor(NOT_ASKED)
    ends = [np.arange(count + 1) - 0.5 for count in reversed(shape)]
    axes.pcolormesh(*ends, np.ma.masked_invalid(colours), cmap="RdBu_r", norm=TwoSlopeNorm(0.0, -DECADES, DECADES))
    axes.invert_yaxis()


def _table(
    rows: Sequence[Row], chart: Chart, names: Sequence[str], columns: Sequence[str], measure: str
) -> dict[tuple[int, int], float | None]:
    """Value of a measure by row and column of the map."""
    return {
        (names.index(_label(row, chart.rows)), columns.index(_label(row, chart.columns))): row.get(measure)
        for row in rows
    }


def _labels(rows: Sequence[Row], keys: Sequence[str]) -> list[str]:
    """In the order of their first row; a single number's by its size."""
    ordered = rows
    if len(keys) == 1 and all(isinstance(row[keys[0]], float) for row in rows):
        ordered = sorted(rows, key=lambda row: float(row[keys[0]]))
    return list(dict.fromkeys(_label(row, keys) for row in ordered))


def _label(row: Given, keys: Sequence[str]) -> str:
    return ", ".join(_words(key, row[key]) for key in keys).replace("_", " ").replace("cfl", "CFL")


def _words(key: str, value: Any) -> str:
    """A name speaks for itself; a number with what it is of."""
    if isinstance(value, bool):
        return key if value else f"no {key}"
    return value if isinstance(value, str) else f"{key} {value:.4g}"
