"""The chart of the correspondence maps: the paper's law less the exact one over R1 and R2."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from fe_contact.assembly.forms import Array
from fe_contact.studies import style

PANELS, LEVELS, MICRO = 2.9, 8, 1e6  # look: height, in; lines of a map at most; physics: µs in a s
SHOWN = {"restitution": (1.0, "restitution, less the exact one"), "duration": (100.0, "contact time, % too long")}


def plot_correspondence(
    R1: Array, R2: Array, off: Mapping[str, Array], places: tuple[Array, Array, Array], where: Path
) -> tuple[Path, Path]:
    """Write ``correspondence.svg`` and ``.png`` into ``where``; their paths.

    ``R1``, ``R2``, s, and what is ``off`` by quantity: (cases,); ``places``: R1, R2 and finite elements' error over
    both bars, (places,).
    """
    lines = [
        "The correspondence principle, cut at zero force, against Ting's exact law. Dots: finite elements agree with "
        "the exact law within both bars; crosses: they do not."
    ]
    with style.sheet(where, "correspondence", "The paper's law in the rebound", lines, PANELS, width=125) as sheet:
        for place, axes in enumerate(sheet.panels(1, 2, 0.075, 0.985, wspace=0.2)):
            name = list(SHOWN)[place]
            factor, title = SHOWN[name]
            _map(axes, R1, MICRO * R2, factor * off[name])
            for sign, chosen in (("o", places[2] <= 1.0), ("X", ~(places[2] <= 1.0))):
                axes.plot(MICRO * places[1][chosen], places[0][chosen], sign, color=style.BLACK, markersize=4.0,
                          markerfacecolor=style.SKY, markeredgewidth=0.7, clip_on=False)  # fmt: skip
            axes.set(xlabel="R2, µs", ylabel="" if place else "R1")
            style.label(axes, "ab"[place], title)
    return sheet.paths


def _map(axes: Axes, R1: Array, R2: Array, values: Array) -> None:
    rows, columns = np.unique(R1), np.unique(R2)
    grid = np.full((rows.size, columns.size), np.nan)
    grid[np.searchsorted(rows, R1), np.searchsorted(columns, R2)] = values
    levels = np.asarray(MaxNLocator(LEVELS).tick_values(float(np.nanmin(values)), float(np.nanmax(values))))
    axes.contourf(columns, rows, np.ma.masked_invalid(grid), levels=levels, cmap="cividis", alpha=0.75)
    lines = axes.contour(columns, rows, np.ma.masked_invalid(grid), levels=levels, colors=style.BLACK, linewidths=0.5)
    axes.clabel(lines, fontsize=6.0, fmt="%g")
    axes.set(xscale="log", yscale="log")
