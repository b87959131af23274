"""Maps of where methods break: one chart a study, one panel a measure."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure

from fe_contact.settings import Given
from fe_contact.studies import style
from fe_contact.studies.stability.base import Chart, Measure, Row, studies

CELL, LETTER = 0.16, 0.062  # height of a row, width of a letter of its name, in
UPRIGHT = 0.085  # width of a column's name that stands upright, in
TALLEST = 9.0  # panels that are taller together stand beside each other, in
BESIDE, LINE = 0.12, 0.13  # between them; height of a line of their titles, in
DECADES = 2.0  # either side of the limit that the colours span
TITLE_WIDTH, INDENT = 132, 3  # look: characters; of a panel's letter before its title
FEW = 4  # columns, in whose cells there is room for numbers
NOT_ASKED = "0.9"
LINES = [
    "Blue: below its limit; red: above it; the more colour the farther, to a hundredth and a hundredfold. Cross: a "
    "named failure, or nothing to tell. Grey: not asked.",
]


def plot_stability(rows: Sequence[Row], where: Path) -> list[Path]:
    """Write ``<study>.svg`` and ``.png`` of every study that has rows into the folder ``where``; their paths."""
    found = list[Path]()
    for study in dict.fromkeys(row["study"] for row in rows):
        own = [row for row in rows if row["study"] == study]
        member = studies()[study]
        with style.look():
            figure = _map(own, member.title, member.chart)
            found += style.save(figure, where, study)
    return found


@dataclass(frozen=True)
class _Layout:
    """Where panels stand, in inches: ``across`` of them in a row, each ``wide`` and ``tall``, ``left`` of the first.

    ``above``: room for heading and title; ``title``: height of a panel's title; ``below``: of the names of columns.
    """

    count: int
    across: int
    left: float
    wide: float
    tall: float
    above: float
    title: float
    below: float

    @classmethod
    def of(cls, chart: Chart, names: Sequence[str], columns: Sequence[str]) -> _Layout:
        """For rows and columns of these names."""
        count, tall = len(chart.measures), CELL * len(names)
        across = min(math.ceil(count * tall / TALLEST), count)
        left = 0.3 + LETTER * max(map(len, names))
        wide = (0.985 * style.PAGE - left - (across - 1) * BESIDE) / across
        below = 0.3 if len(columns) <= FEW else 0.2 + LETTER * max(map(len, columns))
        lines = max(len(_wrapped(measure, wide)) for measure in chart.measures.values())
        above = style.heading_height(LINES, TITLE_WIDTH) - 0.05
        return cls(count, across, left, wide, tall, above, 0.22 + LINE * lines, below)

    @property
    def height(self) -> float:
        """Of the figure."""
        return self.above + -(-self.count // self.across) * (self.tall + self.title) + self.below

    def box(self, place: int) -> tuple[float, float, float, float]:
        """Of a panel, in shares of the figure."""
        down, along = divmod(place, self.across)
        left = self.left + along * (self.wide + BESIDE)
        bottom = self.height - self.above - (down + 1) * (self.tall + self.title)
        return left / style.PAGE, bottom / self.height, self.wide / style.PAGE, self.tall / self.height


def _map(rows: Sequence[Row], title: str, chart: Chart) -> Figure:
    names, columns = _labels(rows, chart.rows), _labels(rows, chart.columns)
    layout = _Layout.of(chart, names, columns)
    figure = Figure(figsize=(style.PAGE, layout.height))
    for place, (name, measure) in enumerate(chart.measures.items()):
        axes = figure.add_axes(layout.box(place))
        _panel(axes, _table(rows, chart, names, columns, name), measure)
        style.label(axes, "abcdefgh"[place], "\n".join(_wrapped(measure, layout.wide)).lstrip())
        axes.set_yticks(range(len(names)), [""] * len(names) if place % layout.across else names, fontsize=5.6)
        last = place + layout.across >= layout.count
        rotation = 0 if len(columns) <= FEW else 90
        every = 1 if len(columns) <= FEW else math.ceil(UPRIGHT * len(columns) / layout.wide)  # as many as have room
        shown = [one if last and not number % every else "" for number, one in enumerate(columns)]
        axes.set_xticks(range(len(columns)), shown, rotation=rotation, fontsize=5.6)
    style.heading(figure, title, LINES, TITLE_WIDTH)
    return figure


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
