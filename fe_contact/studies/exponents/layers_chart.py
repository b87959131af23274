"""The chart of exponents: from the half-space to the thin layer, exact curves and spots by finite elements."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from fe_contact.studies import style
from fe_contact.studies.exponents.layers import Check, ExponentCurve
from fe_contact.studies.style import Look

PANEL = 2.35  # height of a panel, in
TITLE_WIDTH = 132  # characters
ROWS = ("cone", "sphere", "cylinder")
DASHED, DOTTED = (0, (4, 2)), ":"
COLOURS = {
    None: style.GREY,
    0.0: style.SKY,
    0.3: style.BLUE,
    0.45: style.GREEN,
    0.49: style.ORANGE,
    0.5: style.VERMILION,
}
POWER_NU = 0.3  # of the panel that compares profiles
LINES = [
    "Lines: the layer's integral equation; circles: finite elements with their bars. Dotted: the exponent of Table 1's "
    "row; dashed: limits of the thin layer, whose strips yield on their own, or, bonded and incompressible, are "
    "squeezed out like a fluid.",
    "D = F/(E* depth^alpha) with alpha of the row, over the row's own D: 1 where Table 1 holds.",
]


def plot_layers(curves: Sequence[ExponentCurve], checks: Sequence[Check], where: Path) -> tuple[Path, Path]:
    """Write ``exponents.svg`` and ``exponents.png`` into the folder ``where``; their paths."""
    rows = len(ROWS) + 1
    title = "Exponents between half-space and thin layer"
    with style.sheet(where, "exponents", title, LINES, rows * PANEL, width=TITLE_WIDTH) as sheet:
        panels = iter(sheet.panels(rows, 2, 0.075, 0.985, wspace=0.22, hspace=0.34))
        letters = iter("abcdefgh")
        for name in ROWS:
            own, spots = [c for c in curves if c.profile.name == name], [c for c in checks if c.profile.name == name]
            left, right = next(panels), next(panels)
            _exponents(left, own, spots)
            _factors(right, own, spots)
            style.label(left, next(letters), f"{name}: local exponent")
            style.label(right, next(letters), f"{name}: D over the row's")
        left, right = panels
        _families(left, [c for c in curves if c.base == "bonded" and c.nu == POWER_NU], checks)
        _factors(right, *(_of_punch(found) for found in (curves, checks)))
        style.label(left, next(letters), f"profiles $r^n$, bonded, ν = {POWER_NU:g}: local exponent")
        style.label(right, next(letters), "punch: D over the row's")
        for axes in (left, right):
            axes.set(xlabel="contact radius over thickness")
    return sheet.paths


def _exponents(axes: Axes, curves: Sequence[ExponentCurve], checks: Sequence[Check]) -> None:
    """One profile, a line a layer, named beside; its limits at the right end."""
    for curve in curves:
        axes.plot(curve.ratio, curve.exponent, **_look(curve))
    _spots(axes, checks, "exponent")
    _limits(axes, curves)
    axes.set(xscale="log", ylabel="d ln F/d ln depth")


def _families(axes: Axes, curves: Sequence[ExponentCurve], checks: Sequence[Check]) -> None:
    """All axisymmetric profiles on one layer, coloured by their exponent."""
    chosen = [curve for curve in curves if not curve.profile.plane]
    for colour, curve in zip((*style.CYCLE, style.BLACK), chosen, strict=False):
        axes.plot(curve.ratio, curve.exponent, color=colour, label=curve.profile.label)
        axes.plot(curve.ratio[-1] * 1.12, curve.thin, marker="_", markersize=7.0, color=colour)
        spots = [one for one in checks if (one.profile, one.base, one.nu) == (curve.profile, curve.base, curve.nu)]
        _spots(axes, spots, "exponent", colour)
    axes.set(xscale="log", ylabel="d ln F/d ln depth")
    axes.legend(loc="upper left", fontsize=5.6, labelspacing=0.2, handlelength=1.4, ncols=2)


def _factors(axes: Axes, curves: Sequence[Any], checks: Sequence[Any]) -> None:
    for curve in curves:
        axes.plot(curve.ratio, curve.factor, label=_layer(curve), **_look(curve))
    _spots(axes, checks, "factor")
    axes.axhline(1.0, color=style.BLACK, linewidth=0.7, linestyle=DOTTED)
    axes.set(xscale="log", yscale="log", ylabel="D over the row's")
    axes.legend(loc="upper left", fontsize=5.6, labelspacing=0.2, handlelength=1.4)


def _spots(axes: Axes, checks: Sequence[Check], name: str, colour: str | None = None) -> None:
    """Finite elements, with bars."""
    for check in checks:
        found = getattr(check, name)
        axes.errorbar([check.ratio], [found.value], yerr=[found.error], color=colour or COLOURS[check.nu], marker="o",
                      markersize=3.6, markerfacecolor="white", linewidth=0.9, zorder=4)  # fmt: skip


def _limits(axes: Axes, curves: Sequence[ExponentCurve]) -> None:
    """The row's exponent dotted, the thin layer's dashed, each with its number at the end."""
    row = curves[0].profile.row
    limits = sorted({curve.thin for curve in curves})
    for value, dashes in [(row, DOTTED), *((limit, DASHED) for limit in limits)]:
        axes.axhline(value, color=style.BLACK, linewidth=0.7, linestyle=dashes)
        axes.text(1.01, value, f"{value:g}", transform=axes.get_yaxis_transform(), va="center", fontsize=6.5)
    span = limits[-1] - row
    axes.set(ylim=(row - 0.06 * span, row + 1.1 * span))


def _look(curve: ExponentCurve) -> Look:
    sliding = curve.base == "sliding"
    return {"color": COLOURS[curve.nu], "linewidth": 1.0, "linestyle": (0, (1.2, 1.0)) if sliding else "-"}


def _layer(curve: ExponentCurve) -> str:
    return "sliding, any ν" if curve.nu is None else f"{curve.base}, ν = {curve.nu:g}"


def _of_punch(found: Sequence[Any]) -> list[object]:
    return [one for one in found if np.isinf(one.profile.n)]
