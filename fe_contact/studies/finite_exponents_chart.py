"""The chart of exponents at large strains: how far they depart over depth, and what of that the energies share."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from fe_contact.studies import style
from fe_contact.studies.finite_exponents import ENERGIES, LIMITS, Departures
from fe_contact.studies.style import Look
from lumped.result.model_ledger import ENERGY_NAMES

PANEL = 2.7  # height, in
COLUMNS, LINE = 2, 0.16  # of the names below the panels; height of a line of them, in
DASHES = ("-", "--")  # look: by energy; on the right geometry and material
LINES = [
    f"Left: local exponent over that of small strain, less one, {ENERGY_NAMES[ENERGIES[0]]} (full) and "
    f"{ENERGY_NAMES[ENERGIES[1]]} (dashed), with their bars. Right: what both change alike, geometry (full), and what "
    "they differ by, material (dashed). Dotted: departures of 1, 5 and 10 %. Depth over R, over h where there is no R.",
]


def plot_finite(study: str, found: Sequence[Departures], where: Path) -> None:
    """Write ``<study>_finite.svg`` and ``.png`` into the folder ``where``."""
    shown = [one for one in found if one.small is not None]
    title, below = "Exponents at large strains", 0.5 + LINE * -(-len(shown) // COLUMNS)
    with style.sheet(where, f"{study}_finite", title, LINES, PANEL, below=below) as sheet:
        left, right = sheet.panels(1, 2, 0.075, 0.985, wspace=0.22)
        for place, one in enumerate(shown):
            _row(left, right, one, (*style.CYCLE, style.GREY, style.BLACK)[place % 8])
        for axes, letter, title in ((left, "a", "departure of the exponent"), (right, "b", "geometry and material")):
            for limit in LIMITS:
                for sign in (1.0, -1.0):
                    axes.axhline(100.0 * sign * limit, color=style.GREY, linewidth=0.6, linestyle=":")
            axes.set(xscale="log", xlabel="depth over R, or h", ylabel="%")
            style.label(axes, letter, title)
        handles, labels = left.get_legend_handles_labels()
        sheet.figure.legend(handles, labels, loc="lower left", bbox_to_anchor=(0.06, 0.0), ncols=COLUMNS)


def _row(left: Axes, right: Axes, one: Departures, colour: str) -> None:
    """Both energies, and both parts."""
    depth = np.array(one.row.depths) / next(iter(one.row.lengths.values()), 1.0)
    look: Look = {"color": colour, "linewidth": 1.0}
    for energy, dashes in zip(one.large, DASHES, strict=True):
        departure, bar = one.departure(energy)
        label = one.row.label if dashes == DASHES[0] else None
        left.errorbar(depth, 100.0 * departure, yerr=100.0 * bar, linestyle=dashes, elinewidth=0.4, label=label, **look)
    for part, dashes in zip((one.geometry, one.material), DASHES, strict=True):
        right.plot(depth, 100.0 * part, linestyle=dashes, **look)
