"""The chart of Table 1 on trial: E* over Poisson's ratio, how far the power laws hold, line contact's datum."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fe_contact.report import style
from fe_contact.validation.datum import DEPTH
from fe_contact.validation.table1 import LIMIT, Trial, bodies
from fe_contact.validation.table1_verdict import verdict

PANEL = 2.55  # height of a panel, in
TITLE_WIDTH = 132  # characters
RATIOS = np.linspace(0.0, 0.46, 93)
MARKERS = ("o", "s", "D", "^", "v", "P", "X", "h")
SUPPORTS = {"datum": style.BLUE, "bonded layer": style.VERMILION}
DASHED = (0, (3, 1.6))
TABLE_ALPHA = 1.0


def plot_table1(trials: Sequence[Trial], where: Path) -> tuple[Path, Path]:
    """Write ``table1.svg`` and ``table1.png`` into the folder ``where``; their paths."""
    judged = [(trial.row, verdict(trial)) for trial in trials]
    lines = [f"{row.number}  {row.case}: {one.word}: {one.sentence}" for row, one in judged]
    with style.look():
        above, below = style.heading_height(lines, TITLE_WIDTH) + 0.35, 0.45
        height = above + 2 * PANEL + below
        figure = Figure(figsize=(style.PAGE, height))
        grid = figure.add_gridspec(2, 2, wspace=0.24, hspace=0.42)
        grid.update(left=0.075, right=0.985, top=1 - above / height, bottom=below / height)
        panels = [figure.add_subplot(grid[place // 2, place % 2]) for place in range(4)]
        _moduli(panels[0], trials)
        _departures(panels[1], trials)
        _datum(panels[2], panels[3], trials)
        titles = ("modulus over Poisson's ratio", "force over the corrected row's",
                  f"line contact: D at a depth of R/{1 / DEPTH:g}", "line contact: exponent there")  # fmt: skip
        for axes, letter, title in zip(panels, "abcd", titles, strict=True):
            style.label(axes, letter, title)
        style.heading(figure, "Table 1 on trial", lines, TITLE_WIDTH)
        return style.save(figure, where, "table1")


def _look(trial: Trial) -> tuple[str, str]:
    """Colour and marker of a row."""
    place = trial.row.number - 1
    return (*style.CYCLE, style.GREY, style.BLACK)[place], MARKERS[place]


def _moduli(axes: Axes, trials: Sequence[Trial]) -> None:
    """E* over its value at nu = 0: finite elements, the corrected rows, and dashed the printed ones that differ."""
    for trial in trials:
        if not trial.moduli:
            continue
        row, (colour, marker) = trial.row, _look(trial)
        unit = row.modulus(*bodies(row, 0.0))
        corrected = np.array([row.modulus(*bodies(row, nu)) for nu in RATIOS]) / unit
        printed = np.array([row.printed_modulus(*bodies(row, nu)) for nu in RATIOS]) / unit
        axes.plot(RATIOS, corrected, color=colour, linewidth=0.9)
        if not np.allclose(printed, corrected):
            axes.plot(RATIOS, printed, color=colour, linewidth=0.9, linestyle=DASHED, label=f"{row.name}, printed")
        values = [(one.value or 0.0) / unit for one in trial.moduli.values()]
        bars = [(one.error or 0.0) / unit for one in trial.moduli.values()]
        axes.errorbar(list(trial.moduli), values, yerr=bars, color=colour, linestyle="", marker=marker,
                      markersize=2.0 + 1.2 * row.number, markerfacecolor="none", label=f"{row.name}, FE")  # fmt: skip
    axes.set(xlabel="Poisson's ratio", ylabel="E* over its value at ν = 0")
    axes.legend(loc="upper left", fontsize=6.0, labelspacing=0.25)


def _departures(axes: Axes, trials: Sequence[Trial]) -> None:
    """In per cent; the band is what counts as holding."""
    percent = 100.0 * LIMIT
    axes.axhspan(-percent, percent, color="#efefef", linewidth=0.0)
    for trial in trials:
        if trial.reach is not None:
            colour, marker = _look(trial)
            axes.plot(trial.reach.depth, 100.0 * trial.reach.departure, color=colour, marker=marker, markersize=3.0,
                      linewidth=0.8, label=trial.row.name)  # fmt: skip
    axes.set(xscale="log", ylim=(-6.5 * percent, 2.5 * percent))
    axes.set(xlabel="depth over the row's length", ylabel="departure, %")
    axes.legend(loc="lower left", fontsize=6.0, labelspacing=0.25)


def _datum(left: Axes, right: Axes, trials: Sequence[Trial]) -> None:
    """D and exponent over datum or thickness: exact lines, finite elements with bars, and what the table prints."""
    for trial in trials:
        for support, colour in SUPPORTS.items():
            own = [place for place in trial.datum if place.support == support]
            exact = [place for place in own if place.method == "exact"]
            checked = [place for place in own if place.method == "fe"]
            if not own:
                continue
            for axes, name in ((left, "factor"), (right, "alpha")):
                axes.plot([one.length for one in exact], [getattr(one, name).value for one in exact], color=colour,
                          label=f"{support}, exact")  # fmt: skip
                axes.errorbar([one.length for one in checked], [getattr(one, name).value for one in checked],
                              yerr=[getattr(one, name).error for one in checked], linestyle="", color=colour,
                              marker="o", markersize=4.0, markerfacecolor="white", label=f"{support}, FE")  # fmt: skip
    for axes, printed, name in ((left, 0.25 * np.pi, "printed, π/4"), (right, TABLE_ALPHA, "printed, 1")):
        axes.axhline(printed, color=style.BLACK, linewidth=0.8, linestyle=DASHED, label=name)
        axes.set(xscale="log", xlabel="datum or thickness over R")
        axes.legend(loc="upper right", fontsize=6.0, labelspacing=0.25)
    left.set(ylabel="D/l = F/(E* l depth)")
    right.set(ylabel="d ln F/d ln depth")
