"""The chart of Table 1 on trial: E* of every row, how far power laws hold, line contact's datum, bonded blocks."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import NullFormatter

from fe_contact.studies import style
from fe_contact.studies.table1.limits import DEPTH, LIMIT
from fe_contact.studies.table1.study import RATIOS, Trial, bodies
from fe_contact.studies.table1.verdict import verdict
from lumped.result.result import Quantity

PANEL = 2.55  # height of a panel, in
SHIFT = 0.2  # of the points of one row, nu by nu
MARKERS = ("o", "s", "D", "^", "v", "P", "X", "h")
SUPPORTS = {
    "datum": style.BLUE,
    "bonded layer": style.VERMILION,
    "free": style.GREEN,
    "held": style.PURPLE,
}
DASHED = (0, (3, 1.6))  # look: points drawn and left out
TABLE_ALPHA = 1.0  # physics: the exponent as printed in the table


def plot_table1(trials: Sequence[Trial], where: Path) -> tuple[Path, Path]:
    """Write ``table1.svg`` and ``table1.png`` into the folder ``where``; their paths."""
    judged = [(trial.row, verdict(trial)) for trial in trials]
    lines = [f"{row.number}  {row.case}: {one.word}: {one.sentence}" for row, one in judged]
    with style.sheet(where, "table1", "Table 1 on trial", lines, 3 * PANEL) as sheet:
        grid = sheet.grid(3, 2, 0.075, 0.985, wspace=0.24, hspace=0.42)
        places = [grid[place // 2, place % 2] for place in range(4)]
        panels = [sheet.figure.add_subplot(place) for place in (*places, grid[2, :])]
        _moduli(panels[0], trials)
        _departures(panels[1], trials)
        _datum(panels[2], panels[3], trials)
        _bonded(panels[4], trials)
        titles = (
            "identified modulus",
            "force over the corrected row's",
            f"line contact: D at a depth of R/{1 / DEPTH:g}",
            "line contact: exponent there",
            "blocks with bonded faces and free sides",
        )
        for axes, letter, title in zip(panels, "abcde", titles, strict=True):
            style.label(axes, letter, title)
    return sheet.paths


def _look(trial: Trial) -> tuple[str, str]:
    """Colour and marker of a row."""
    place = trial.row.number - 1
    return (*style.CYCLE, style.GREY, style.BLACK)[place], MARKERS[place]


def _moduli(axes: Axes, trials: Sequence[Trial]) -> None:
    """E* over the printed one, row by row: finite elements with bars, and dashes where the corrected row lies."""
    axes.axhline(1.0, color=style.BLACK, linewidth=0.8, linestyle=DASHED)
    for place, nu in enumerate(RATIOS):
        tried = [trial for trial in trials if nu in trial.moduli]
        numbers = np.array([trial.row.number for trial in tried]) + SHIFT * (place - 1)
        printed = np.array([trial.row.printed_modulus(*bodies(trial.row, nu)) for trial in tried])
        corrected = np.array([trial.row.modulus(*bodies(trial.row, nu)) for trial in tried])
        found = np.array([trial.moduli[nu].value or 0.0 for trial in tried])
        bars = np.array([trial.moduli[nu].error or 0.0 for trial in tried])
        colour = style.CYCLE[place]
        axes.errorbar(numbers, found / printed, yerr=bars / printed, color=colour, linestyle="", marker="o",
                      markersize=4.0, markerfacecolor="none", label=f"ν = {nu:g}, FE")  # fmt: skip
        axes.plot(numbers, corrected / printed, color=colour, linestyle="", marker="_", markersize=8.0)
        struck = [(trial.impact.moduli[nu].value or 0.0) if trial.impact else np.nan for trial in tried]
        axes.plot(numbers + 0.3 * SHIFT, struck / printed, color=colour, linestyle="", marker="x", markersize=3.2)
    axes.plot([], [], color=style.GREY, linestyle="", marker="_", markersize=8.0, label="corrected row")
    axes.plot([], [], color=style.GREY, linestyle="", marker="x", markersize=3.2, label="FE, from impact")
    axes.set(xlabel="row", ylabel="E* over the printed one", xticks=range(1, 9))
    axes.legend(loc="upper left", fontsize=6.0, labelspacing=0.25)


def _departures(axes: Axes, trials: Sequence[Trial]) -> None:
    """In per cent; the band is what counts as holding."""
    percent = 100.0 * LIMIT
    axes.axhspan(-percent, percent, color="#efefef", linewidth=0.0)
    for trial in trials:
        if trial.reach is not None:
            colour, marker = _look(trial)
            axes.plot(trial.reach.depth, 100.0 * trial.reach.departure, color=colour, marker=marker, markersize=3.0,
                      linewidth=0.8, label=trial.row.name.replace("_", " "))  # fmt: skip
    axes.set(xscale="log", ylim=(-6.5 * percent, 2.5 * percent))
    axes.set(xlabel="depth over the row's length", ylabel="departure, %")
    axes.legend(loc="lower left", fontsize=6.0, labelspacing=0.25)


def _datum(left: Axes, right: Axes, trials: Sequence[Trial]) -> None:
    """D and exponent over datum or thickness: exact lines, finite elements with bars, and what the table prints."""
    for trial in trials:
        for support, colour in SUPPORTS.items():
            own = [place for place in trial.datum if place.support == support]
            if own:
                label = f"{trial.row.name.replace('_', ' ')}, {support}"
                _places(left, [(one.length, one.factor, one.method) for one in own], colour, label)
                _places(right, [(one.length, one.alpha, one.method) for one in own], colour, label)
    for axes, printed, name in ((left, 0.25 * np.pi, "printed, π/4"), (right, TABLE_ALPHA, "printed, 1")):
        axes.axhline(printed, color=style.BLACK, linewidth=0.8, linestyle=DASHED, label=name)
        axes.set(xscale="log", xlabel="datum, thickness or the struck radius over R")
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.legend(loc="upper right", fontsize=6.0, labelspacing=0.25)
    left.set(ylabel="D/l = F/(E* l depth)")
    right.set(ylabel="d ln F/d ln depth")


def _places(axes: Axes, places: Sequence[tuple[float, Quantity, str]], colour: str, label: str) -> None:
    """One support: a line of exact places, circles with bars by finite elements, crosses from impacts."""
    exact = [(length, one.value or 0.0) for length, one, method in places if method == "exact"]
    if exact:
        axes.plot(*zip(*exact, strict=True), color=colour)
    for way, marker in (("fe", "o"), ("impact", "x")):
        found = [(length, one.value or 0.0, one.error or 0.0) for length, one, method in places if method == way]
        x, y, bars = zip(*found, strict=True) if found else ((), (), ())
        axes.errorbar(x, y, yerr=bars, linestyle="", color=colour, marker=marker, markersize=4.0,
                      markerfacecolor="white", label=label if way == "fe" else None)  # fmt: skip


def _bonded(axes: Axes, trials: Sequence[Trial]) -> None:
    """Modulus over Young's from slender to wide blocks, between those of rows 1 and 2."""
    tried = dict.fromkeys(block for trial in trials for block in trial.bonded)
    rows = [trial.row for trial in trials if trial.bonded]
    for colour, body in zip((style.BLUE, style.VERMILION), dict.fromkeys(block.body for block in tried), strict=False):
        own = [block for block in tried if block.body == body]
        axes.errorbar([block.width for block in own], [(block.modulus.value or 0.0) / body.young for block in own],
                      yerr=[(block.modulus.error or 0.0) / body.young for block in own], color=colour, marker="o",
                      markersize=4.0, markerfacecolor="white", linewidth=0.8, label=f"ν = {body.nu:g}, FE")  # fmt: skip
        for row in rows:
            axes.axhline(row.modulus(body) / body.young, color=colour, linewidth=0.8, linestyle=DASHED)
    axes.set(xscale="log", xlabel="radius over thickness", ylabel="F l/(A depth) over E")
    axes.plot([], [], color=style.GREY, linewidth=0.8, linestyle=DASHED, label="rows 1 and 2")
    axes.legend(loc="center left", fontsize=6.0, labelspacing=0.25)
