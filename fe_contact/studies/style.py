"""One look for every chart: paper column widths, colours that colour-blind readers tell apart, files without a date."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from string import ascii_lowercase
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from lumped.schema.csv_file import write_csv

COLUMN, PAGE = 3.5, 7.2  # widths of a paper's column and page, in
TITLE_SIZE, TITLE_LETTERS = 9.5, 11.5  # pt; letters of that size in an inch
CHARACTERS = 122  # look: of the lines below the title, on a page
LEAST_TITLE = 0.65  # of that size: a title of more letters is smaller, at most by so much, and then cut

# Okabe and Ito's palette, https://jfly.uni-koeln.de/color/
BLACK, GREY = "#1a1a1a", "#8c8c8c"
BLUE, ORANGE, GREEN, VERMILION = "#0072B2", "#E69F00", "#009E73", "#D55E00"
PURPLE, SKY = "#CC79A7", "#56B4E9"
CYCLE = (VERMILION, BLUE, GREEN, PURPLE, ORANGE, SKY)
# A law has one colour in every chart; laws of one kind have neighbouring ones.
LAWS = {
    "linear_spring": "#7f7f7f", "kelvin": "#2f4b7c", "mahmoud": "#8a6d1f", "impact_bilinear": "#5b3a1e",
    "hertz": ORANGE, "jankowski": "#e0218a", "hunt_crossley": PURPLE, "hertzdamp": "#8e44ad",
    "khatiwada": "#5e2b80", "tsuji": "#b0003a", "kuwabara_kono": "#7a9a01",
    "correspondence": VERMILION, "ting": BLUE, "mdr": GREEN, "rod_waves": "#00a3b4",
    "bar_waves": "#0b5d57",
}  # fmt: skip

Look = dict[str, Any]  # keywords of matplotlib, each of its own type
RC: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 7.5,
    "axes.titlesize": 8.0,
    "axes.titlelocation": "left",
    "axes.labelsize": 7.5,
    "axes.labelcolor": BLACK,
    "axes.edgecolor": "#4d4d4d",
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.color": "#4d4d4d",
    "ytick.color": "#4d4d4d",
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
    "lines.linewidth": 1.2,
    "legend.frameon": False,
    "legend.fontsize": 7.0,
    "legend.handlelength": 1.8,
    "figure.dpi": 100,
    "savefig.dpi": 300,
    "svg.fonttype": "none",
    "svg.hashsalt": "fe-contact",
}
UNNAMED = "_child"  # how matplotlib begins the name of a line that was given none
DRAWN = "{:.7g}"  # look: of a point
PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}  # by power of ten


def law_colour(name: str) -> str:
    """The colour of a law, black where it has none of its own."""
    return LAWS.get(name, BLACK)


@contextmanager
def look() -> Iterator[None]:
    """The look, for as long as a figure is made and saved."""
    with matplotlib.rc_context(RC):
        yield


def save(figure: Figure, where: Path, name: str) -> None:
    """Write ``name.svg`` and ``name.png`` into a folder, made when it is not there; the same bytes every time."""
    where.mkdir(parents=True, exist_ok=True)
    figure.savefig(where / f"{name}.svg", metadata={"Date": None})
    figure.savefig(where / f"{name}.png", metadata={"Software": None})


def write_curves(figure: Figure, where: Path, name: str) -> None:
    """Write ``name.csv``: what a figure draws, a row a point of every curve that has a name, in the axes' units.

    A name that begins with ``_`` stands in no legend.
    """
    rows = list[tuple[object, ...]]()
    for letter, axes in zip(ascii_lowercase, figure.axes, strict=False):
        panel = f"{letter} {axes.get_title('left').partition('$  ')[2]}".strip()
        meanings = [_shared(figure, axes, of) for of in (Axes.get_xlabel, Axes.get_ylabel)]
        for line in axes.lines:
            curve = str(line.get_label())
            if not curve.startswith(UNNAMED):
                points = np.asarray(line.get_xydata())
                rows += [(panel, curve.removeprefix("_"), *meanings, *map(DRAWN.format, point)) for point in points]
    write_csv(where / f"{name}.csv", ("panel", "curve", "x_is", "y_is", "x", "y"), rows)


def _shared(figure: Figure, axes: Axes, label: Callable[[Axes], str]) -> str:
    """What an axis says, or where it leaves that to its neighbours, they."""
    return next(filter(None, map(label, (axes, *figure.axes))))


def prefixed(largest: float, unit: str) -> tuple[float, str]:
    """Factor and unit with which the largest value of an axis reads as a number from 1 to 1000.

    Pascals are not divided: a milli- would be read as a mega-, which is what moduli have.
    """
    power, least = 0, 0 if unit.startswith("Pa") else -12
    while largest * 10.0**-power >= 1000.0 and power < 12:
        power += 3
    while 0.0 < largest * 10.0**-power < 1.0 and power > least:
        power -= 3
    return 10.0**-power, PREFIXES[power] + unit


def readable(value: float, unit: str, digits: int = 4) -> str:
    """A value with some digits and its prefixed unit."""
    factor, name = prefixed(abs(value), unit)
    return f"{value * factor:.{digits}g} {name}".rstrip()


MINUTE = 1e-6  # share of a value below which a bar is written as such a share


def with_error(value: float, error: float, unit: str = "") -> str:
    """A value with its error bar in the same unit, cut at the bar's first digit; a minute bar as a share of it."""
    factor, name = prefixed(abs(value), unit) if unit else (1.0, "")
    if 0.0 < error < MINUTE * abs(value):
        return f"{value * factor:.6g} {name}".rstrip() + f" ± {error / abs(value):.0e} of it"
    digits = max(0, -math.floor(math.log10(error * factor))) if error > 0.0 else 4
    return f"{value * factor:.{digits}f} ± {error * factor:.{digits}f} {name}".rstrip()


def plain_numbers(*axes: Axis) -> None:
    """Where an axis is logarithmic: 1, 2 and 5 of each decade as they are written, and no other."""
    for axis in axes:
        if axis.get_scale() == "log":
            axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axis.set_minor_formatter(NullFormatter())


def label(axes: Axes, letter: str, text: str) -> None:
    """The panel's letter and what it shows, above its upper left corner."""
    axes.set_title(rf"$\bf{{{letter}}}$  {text}", pad=5.0)


def heading(figure: Figure, title: str, lines: list[str], width: int = CHARACTERS) -> None:
    """A bold title and lines below it, wrapped at ``width`` characters, at the figure's upper left."""
    height = figure.get_figheight()
    wrapped = [part for line in lines for part in textwrap.wrap(line, width, subsequent_indent="    ")]
    left, room = 0.08 / figure.get_figwidth(), TITLE_LETTERS * figure.get_figwidth()
    size = TITLE_SIZE * max(LEAST_TITLE, min(1.0, room / max(len(title), 1)))
    shown = title if len(title) <= room / LEAST_TITLE else f"{title[: int(room / LEAST_TITLE) - 1]}…"
    figure.text(left, 1 - 0.06 / height, shown, fontsize=size, fontweight="bold", va="top", color=BLACK)
    figure.text(left, 1 - 0.27 / height, "\n".join(wrapped), va="top", linespacing=1.45, color="#333333")


def heading_height(lines: list[str], width: int) -> float:
    """Room that :func:`heading` needs, in."""
    count = sum(len(textwrap.wrap(line, width, subsequent_indent="    ")) for line in lines)
    return 0.36 + 0.152 * count


def footnote(figure: Figure, text: str) -> None:
    """One line at the figure's lower left."""
    figure.text(0.011, 0.011, text.replace("\n", " "), fontsize=6.0, color="#4d4d4d")


@dataclass(frozen=True)
class Sheet:
    """A figure with panels below a heading; ``top`` and ``bottom`` of all panels, in shares of its height."""

    figure: Figure
    top: float
    bottom: float
    paths: tuple[Path, Path]

    def grid(self, rows: int, columns: int, left: float, right: float, **look: Any) -> GridSpec:
        """Places of panels between two shares of the width."""
        grid = self.figure.add_gridspec(rows, columns, **look)
        grid.update(left=left, right=right, top=self.top, bottom=self.bottom)
        return grid

    def panels(self, rows: int, columns: int, left: float, right: float, **look: Any) -> list[Axes]:
        """A panel in every place of such a grid, row by row."""
        grid = self.grid(rows, columns, left, right, **look)
        return [self.figure.add_subplot(grid[place]) for place in np.ndindex(rows, columns)]


@contextmanager
def sheet(
    where: Path,
    name: str,
    title: str,
    lines: list[str],
    panels: float,
    *,
    width: int = CHARACTERS,
    above: float = 0.35,
    below: float = 0.45,
    size: float = PAGE,
) -> Iterator[Sheet]:
    """A figure to draw on, saved as ``name.svg`` and ``name.png`` in a folder, under a title and wrapped lines.

    `panels`: height of all panels with what is between them, in; `width`: of the lines, in characters; `above` and
    `below` the panels, in; `size`: width, in.
    """
    with look():
        above += heading_height(lines, width)
        height = above + panels + below
        figure = Figure(figsize=(size, height))
        heading(figure, title, lines, width)
        yield Sheet(figure, 1 - above / height, below / height, (where / f"{name}.svg", where / f"{name}.png"))
        save(figure, where, name)
