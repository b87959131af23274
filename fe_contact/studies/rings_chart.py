"""The chart of the rings: force and local exponent over depth, finite elements against the paper's row."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.axes import Axes

from fe_contact.studies import style
from fe_contact.studies.rings import SMALL_STRAIN, RingCurve
from fe_contact.studies.style import Look

TITLE_WIDTH = 132  # characters
PANEL = 2.7  # height, in
LINES = [
    "Finite elements, bars within the lines' width where none is seen. Left: F over (pi/4) E* l depth, 1 (dotted) "
    "where (27)-(32) hold; right: d ln F/d ln depth, by the row 1. Shaded: strains beyond "
    f"{100 * SMALL_STRAIN:g} %, where linear theory only indicates.",
]


def plot_rings(curves: Sequence[RingCurve], where: Path) -> tuple[Path, Path]:
    """Write ``ring.svg`` and ``ring.png`` into the folder ``where``; their paths."""
    title = "Rings pressed slowly against the paper's row"
    with style.sheet(where, "ring", title, LINES, PANEL, width=TITLE_WIDTH) as sheet:
        left, right = sheet.panels(1, 2, 0.075, 0.985, wspace=0.22)
        for colour, curve in zip((*style.CYCLE, style.BLACK), curves, strict=False):
            look: Look = {"color": colour, "marker": "o", "markersize": 2.4, "linewidth": 1.0}
            left.errorbar(curve.strain, curve.factor, yerr=curve.factor_error, label=curve.case.name, **look)
            right.errorbar(curve.strain, curve.exponent, yerr=curve.exponent_error, **look)
        left.set(yscale="log", ylabel="F over the row's")
        style.plain_numbers(left.yaxis)
        right.set(ylabel="d ln F/d ln depth")
        for axes, letter, title in ((left, "a", "force over (27)"), (right, "b", "local exponent")):
            _finished(axes)
            style.label(axes, letter, title)
        left.legend(loc="upper left", fontsize=5.6, labelspacing=0.2)
    return sheet.paths


def _finished(axes: Axes) -> None:
    """The row's line and the strains beyond small ones."""
    axes.set(xscale="log", xlabel="depth over what is pressed")
    axes.axhline(1.0, color=style.BLACK, linewidth=0.7, linestyle=":")
    axes.axvspan(SMALL_STRAIN, axes.get_xlim()[1], color=style.GREY, alpha=0.15, linewidth=0)
