"""The chart of restitution asked for against obtained: a panel a law, a curve a published formula and exit."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from fe_contact.studies import style
from fe_contact.studies.restitution import RestitutionLine
from fe_contact.studies.style import Look
from lumped.restitution import EXACT

COLUMNS, PANEL = 3, 2.45  # panels in a row; height of one, in
SAME = 1e-9  # of two curves that are one
LINES = {"force": "-", "depth": (0, (3, 1.6))}  # look: by exit
COLOURS = (*style.CYCLE, style.GREY)


def plot_restitution(lines: Sequence[RestitutionLine], where: Path) -> None:
    """Write ``restitution.svg`` and ``restitution.png`` into the folder ``where``."""
    names = list(dict.fromkeys(line.law for line in lines))
    rows = -(-len(names) // COLUMNS)
    text = [
        "Black: the exact damping, on the diagonal. Colours: published formulas; solid where contact ends at zero "
        "force, dashed where it ends at depth zero and that differs."
    ]
    title = "Coefficient of restitution: asked for and obtained"
    with style.sheet(where, "restitution", title, text, rows * PANEL, above=0.3) as sheet:
        grid = sheet.grid(rows, COLUMNS, 0.065, 0.985, wspace=0.22, hspace=0.38)
        for i, name in enumerate(names):
            axes = sheet.figure.add_subplot(grid[i // COLUMNS, i % COLUMNS])
            _panel(axes, [line for line in lines if line.law == name])
            style.label(axes, chr(ord("a") + i), name)
            axes.set(xlabel="asked" if i + COLUMNS >= len(names) else "", ylabel="" if i % COLUMNS else "obtained")


def _panel(axes: Axes, lines: Sequence[RestitutionLine]) -> None:
    """One law: published formulas that agree share a curve and a name."""
    axes.plot([0.0, 1.0], [0.0, 1.0], color=style.GREY, linewidth=0.5, zorder=1)
    groups: list[tuple[list[str], list[RestitutionLine]]] = []
    for formula in dict.fromkeys(line.damping for line in lines):
        own = [line for line in lines if line.damping == formula]
        known = next((group for group in groups if _same(group[1][0], own[0])), None)
        if known and formula != EXACT and EXACT not in known[0]:
            known[0].append(formula)
        else:
            groups.append(([formula], own))
    colours = iter(COLOURS)
    for formulas, own in groups:
        colour = style.BLACK if EXACT in formulas else next(colours)
        _curves(axes, own, ", ".join(formulas).replace("_", " "), colour)
    axes.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0), aspect="equal", xticks=[0.0, 0.5, 1.0], yticks=[0.0, 0.5, 1.0])
    axes.legend(loc="upper left", fontsize=4.4, handlelength=1.3, labelspacing=0.15, borderaxespad=0.0)


def _curves(axes: Axes, lines: Sequence[RestitutionLine], name: str, colour: str) -> None:
    for line in lines[:1] if _same(*lines) else lines:
        look: Look = {"linestyle": LINES[line.exit], "color": colour, "linewidth": 1.0}
        values = [np.nan if got is None else got for got in line.obtained]
        axes.plot(line.asked, values, label=name if line is lines[0] else None, **look)


def _same(one: RestitutionLine, other: RestitutionLine) -> bool:
    """Whether two curves are one."""
    first, second = (np.array([np.nan if got is None else got for got in line.obtained]) for line in (one, other))
    return bool(np.allclose(first, second, rtol=0.0, atol=SAME, equal_nan=True))
