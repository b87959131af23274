"""The charts of exponents: on layers, and read from impacts.

On layers from the half-space to the thin layer: exact curves, and spots by finite elements. From impacts the bias over
tau/T: a row a reader, a column a shape, a line a solid.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from fe_contact.methods import FE
from fe_contact.studies import style
from fe_contact.studies.exponents.impacts import EXACT, ON_LAYER, READERS, ImpactExponents
from fe_contact.studies.exponents.layers import Check, ExponentCurve
from fe_contact.studies.exponents.study import Exponents
from fe_contact.studies.style import Look

PANEL, BIAS_PANEL = 2.35, 1.75  # height of a panel, in: on layers, of impacts
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
SOLID_COLOURS = (style.BLUE, style.VERMILION, style.GREEN)
POWER_NU = 0.3  # of the panel that compares profiles
LAYER_LINES = [
    "Lines: the layer's integral equation; circles: finite elements with their bars. Dotted: the exponent of Table 1's "
    "row; dashed: limits of the thin layer, whose strips yield on their own, or, bonded and incompressible, are "
    "squeezed out like a fluid.",
    "D = F/(E* depth^alpha) with alpha of the row, over the row's own D: 1 where Table 1 holds.",
]
IMPACT_LINES = [
    "What is read less the exponent of Table 1's row. Rows: ln F over ln depth while loading; Hunt-Crossley's law; the "
    "correspondence law, each with its exponent free. Lines: exact histories (Ting); circles: finite elements with "
    "their bars. Grey: Ting's law with its exponent free.",
    "Slow and fast relaxation alike leave an elastic contact, and no bias, on a half-space. On a layer the thickness "
    f"adds its own, which Ting's law on the layer's load curve takes away too; there E_i/E_inf = {ON_LAYER:g}.",
]


def plot_exponents(found: Exponents, where: Path) -> None:
    """Both charts, into the folder ``where``."""
    plot_layers(found.curves, found.checks, where)
    plot_impacts(found.impacts, where)


def plot_layers(curves: Sequence[ExponentCurve], checks: Sequence[Check], where: Path) -> None:
    """Write ``exponents.svg`` and ``exponents.png`` into the folder ``where``."""
    rows = len(ROWS) + 1
    title = "Exponents between half-space and thin layer"
    with style.sheet(where, "exponents", title, LAYER_LINES, rows * PANEL) as sheet:
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


def plot_impacts(found: Sequence[ImpactExponents], where: Path) -> None:
    """Write ``exponents_from_impacts.svg`` and ``.png`` into the folder ``where``."""
    columns = _columns(found)
    title = "Exponents read from impacts on a viscoelastic body"
    height = len(READERS) * BIAS_PANEL
    with style.sheet(where, "exponents_from_impacts", title, IMPACT_LINES, height) as sheet:
        panels = sheet.panels(len(READERS), len(columns), 0.08, 0.985, wspace=0.28, hspace=0.3)
        for place, axes in enumerate(panels):
            reader, (name, own) = list(READERS)[place // len(columns)], list(columns.items())[place % len(columns)]
            _biases(axes, own, reader)
            style.label(axes, chr(ord("a") + place), name)
            axes.set(ylabel=f"bias, {reader.replace('_', '-')}" if place % len(columns) == 0 else "")
            axes.set(xlabel="tau/T" if place >= len(panels) - len(columns) else "")
        for axes in panels[: len(columns)]:
            axes.legend(loc="lower right", fontsize=5.6, labelspacing=0.2, handlelength=1.4)


def _columns(found: Sequence[ImpactExponents]) -> Mapping[str, list[ImpactExponents]]:
    """Impacts by what stands above their column: shapes on the half-space, then on layers."""
    columns: dict[str, list[ImpactExponents]] = {}
    for one in sorted(found, key=lambda one: one.impact.wide is not None):
        body = f"exponent {one.impact.profile.row:g}" if one.impact.wide is None else "layer"
        columns.setdefault(f"{one.impact.profile.label}, {body}", []).append(one)
    return columns


def _biases(axes: Axes, found: Sequence[ImpactExponents], reader: str) -> None:
    """One reader on one shape: a line a ratio of moduli, or a thickness."""
    exact = [one for one in found if one.impact.method == EXACT and one.impact.ratio > 1.0]
    labels = list(dict.fromkeys(_solid(one) for one in exact))
    colours = dict(zip(labels, SOLID_COLOURS, strict=False))
    axes.axhline(0.0, color=style.BLACK, linewidth=0.6)
    for label in labels:
        line = sorted((one for one in exact if _solid(one) == label), key=lambda one: one.tau_over_T)
        times = [one.tau_over_T for one in line]
        axes.plot(times, [one.bias(reader) for one in line], color=colours[label], label=label)
        axes.plot(times, [one.corrected.exponent - one.impact.profile.row for one in line],
                  color=style.GREY, linewidth=2.4, alpha=0.5, zorder=1)  # fmt: skip
    for one in found:
        if one.impact.method == FE:
            spot: Look = {"color": colours[_solid(one)], "marker": "o", "markersize": 3.6, "zorder": 4}
            axes.errorbar([one.tau_over_T], [one.bias(reader)], yerr=[one.read[reader].error],
                          markerfacecolor="white", linewidth=0.9, **spot)  # fmt: skip
    axes.set(xscale="log")
    style.plain_numbers(axes.xaxis)


def _solid(one: ImpactExponents) -> str:
    impact = one.impact
    return f"E_i/E_inf = {impact.ratio:g}" if impact.wide is None else f"a/h = {impact.wide:g}"
