"""Charts that the report alone draws: errors over bars of the packaged scenes, and the correspondence maps.

Of the scenes error over its bar of every quantity that has an exact answer; of the maps the paper's law less the exact
one over R1 and R2.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from fe_contact.assembly.forms import Array
from fe_contact.studies import style
from fe_contact.studies.references import Move

ROW, LEAST = 0.165, 1e-4  # look: height of a scene's row, in; the smallest ratio that is drawn
SIGNS = {
    "peak_force": ("o", style.BLUE),
    "peak_depth": ("s", style.ORANGE),
    "duration": ("^", style.GREEN),
    "impulse": ("v", style.SKY),
    "restitution": ("D", style.VERMILION),
    "peak_time": ("P", style.GREY),
    "history_l2": ("X", style.PURPLE),
}
NAMES = {"history_l2": "history"}
LEGEND = 1.15  # look: room for the names of the signs, in
LABELS = 0.29  # look: room for the names of the scenes, of the width
MAP, LEVELS, MICRO = 2.9, 8, 1e6  # look: height, in; lines of a map at most; physics: µs in a s
SHOWN = {
    "restitution": (1.0, "restitution, less the exact one"),
    "duration": (100.0, "contact time, less the exact one, %"),
}


def plot_scenes(held: Mapping[str, Sequence[Move]], where: Path) -> None:
    """Write ``scenes.svg`` and ``scenes.png`` into ``where``; ``held``: differences by what was held against what."""
    lines = ["Difference from the exact answer over the sum of both error bars; left of the line both can be true."]
    with style.sheet(where, "scenes", "Error over its bar", lines, ROW * max(len(held), 3), above=0.08) as sheet:
        axes = sheet.panels(1, 1, LABELS, 1.0 - LEGEND / style.PAGE)[0]
        axes.axvspan(LEAST, 1.0, color=style.GREEN, alpha=0.07, linewidth=0.0)
        axes.axvline(1.0, color=style.BLACK, linewidth=0.9)
        for name, (marker, colour) in SIGNS.items():
            points = [(move.moved, place) for place, moves in enumerate(held.values()) for move in moves
                      if move.quantity == name and move.moved is not None]  # fmt: skip
            x, y = [max(moved, LEAST) for moved, _ in points], [place for _, place in points]
            axes.plot(x, y, marker, color=colour, markersize=3.4, label=NAMES.get(name, name.replace("_", " ")))
        axes.set(xscale="log", xlim=(LEAST, 3.0), ylim=(len(held) - 0.4, -0.6), xlabel="error over its bar")
        axes.set_yticks(range(len(held)), [*held])
        axes.grid(axis="y", color=style.GREY, linewidth=0.3, alpha=0.4)
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0)


def plot_correspondence(
    R1: Array, R2: Array, off: Mapping[str, Array], places: tuple[Array, Array, Array], where: Path
) -> None:
    """Write ``correspondence.svg`` and ``.png`` into ``where``.

    ``R1``, ``R2``, s, and what is ``off`` by quantity: (cases,); ``places``: R1, R2 and finite elements' error over
    both bars, (places,).
    """
    lines = [
        "The correspondence principle, cut at zero force, against Ting's exact law. Dots: finite elements agree with "
        "the exact law within both bars; crosses: they do not."
    ]
    with style.sheet(where, "correspondence", "The paper's law in the rebound", lines, MAP) as sheet:
        for place, axes in enumerate(sheet.panels(1, 2, 0.075, 0.985, wspace=0.2)):
            name = list(SHOWN)[place]
            factor, title = SHOWN[name]
            _map(axes, R1, MICRO * R2, factor * off[name])
            for sign, chosen in (("o", places[2] <= 1.0), ("X", ~(places[2] <= 1.0))):
                axes.plot(MICRO * places[1][chosen], places[0][chosen], sign, color=style.BLACK, markersize=4.0,
                          markerfacecolor=style.SKY, markeredgewidth=0.7, clip_on=False)  # fmt: skip
            axes.set(xlabel="R2, µs", ylabel="" if place else "R1")
            style.label(axes, "ab"[place], title)


def _map(axes: Axes, R1: Array, R2: Array, values: Array) -> None:
    rows, columns = np.unique(R1), np.unique(R2)
    grid = np.full((rows.size, columns.size), np.nan)
    grid[np.searchsorted(rows, R1), np.searchsorted(columns, R2)] = values
    levels = np.asarray(MaxNLocator(LEVELS).tick_values(float(np.nanmin(values)), float(np.nanmax(values))))
    axes.contourf(columns, rows, np.ma.masked_invalid(grid), levels=levels, cmap="cividis", alpha=0.75)
    lines = axes.contour(columns, rows, np.ma.masked_invalid(grid), levels=levels, colors=style.BLACK, linewidths=0.5)
    axes.clabel(lines, fontsize=6.0, fmt="%g")
    axes.set(xscale="log", yscale="log")
