"""The chart of exponents read from impacts: bias over tau/T, a row a reader, a column a shape, a line a solid."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from matplotlib.axes import Axes

from fe_contact.methods import FE
from fe_contact.studies import style
from fe_contact.studies.exponents.impacts import EXACT, ON_LAYER, READERS, ImpactExponents
from fe_contact.studies.exponents.layers import Profile

PANEL = 1.75  # height of a panel, in
TITLE_WIDTH = 132  # characters
COLOURS = (style.BLUE, style.VERMILION, style.GREEN)
LINES = [
    "What is read less the exponent of Table 1's row. Rows: ln F over ln depth while loading; Hunt-Crossley's law; the "
    "correspondence law, each with its exponent free. Lines: exact histories (Ting); circles: finite elements with "
    "their bars. Grey: Ting's law with its exponent free.",
    "Slow and fast relaxation alike leave an elastic contact, and no bias, on a half-space. On a layer the thickness "
    f"adds its own, which Ting's law on the layer's load curve takes away too; there E_i/E_inf = {ON_LAYER:g}.",
]


def plot_impacts(found: Sequence[ImpactExponents], where: Path) -> tuple[Path, Path]:
    """Write ``exponents_from_impacts.svg`` and ``.png`` into the folder ``where``; their paths."""
    columns = _columns(found)
    title = "Exponents read from impacts on a viscoelastic body"
    height = len(READERS) * PANEL
    with style.sheet(where, "exponents_from_impacts", title, LINES, height, width=TITLE_WIDTH) as sheet:
        panels = sheet.panels(len(READERS), len(columns), 0.08, 0.985, wspace=0.28, hspace=0.3)
        for place, axes in enumerate(panels):
            reader, (name, own) = list(READERS)[place // len(columns)], list(columns.items())[place % len(columns)]
            _biases(axes, own, reader)
            style.label(axes, chr(ord("a") + place), name)
            axes.set(ylabel=f"bias, {reader.replace('_', '-')}" if place % len(columns) == 0 else "")
            axes.set(xlabel="tau/T" if place >= len(panels) - len(columns) else "")
        for axes in panels[: len(columns)]:
            axes.legend(loc="lower right", fontsize=5.6, labelspacing=0.2, handlelength=1.4)
    return sheet.paths


def _columns(found: Sequence[ImpactExponents]) -> Mapping[str, list[ImpactExponents]]:
    """Impacts by what stands above their column: shapes on the half-space, then on layers."""
    columns: dict[str, list[ImpactExponents]] = {}
    for one in sorted(found, key=lambda one: one.impact.wide is not None):
        columns.setdefault(_column(one.impact.profile, one.impact.wide is not None), []).append(one)
    return columns


def _column(profile: Profile, on_layer: bool) -> str:
    return f"{profile.label}, {'layer' if on_layer else f'exponent {profile.row:g}'}"


def _biases(axes: Axes, found: Sequence[ImpactExponents], reader: str) -> None:
    """One reader on one shape: a line a ratio of moduli, or a thickness."""
    exact = [one for one in found if one.impact.method == EXACT and one.impact.ratio > 1.0]
    labels = list(dict.fromkeys(_label(one) for one in exact))
    colours = dict(zip(labels, COLOURS, strict=False))
    axes.axhline(0.0, color=style.BLACK, linewidth=0.6)
    for label in labels:
        line = sorted((one for one in exact if _label(one) == label), key=lambda one: one.tau_over_T)
        times = [one.tau_over_T for one in line]
        axes.plot(times, [one.bias(reader) for one in line], color=colours[label], label=label)
        axes.plot(times, [one.corrected.exponent - one.impact.profile.row for one in line],
                  color=style.GREY, linewidth=2.4, alpha=0.5, zorder=1)  # fmt: skip
    for one in found:
        if one.impact.method == FE:
            spot: style.Look = {"color": colours[_label(one)], "marker": "o", "markersize": 3.6, "zorder": 4}
            axes.errorbar([one.tau_over_T], [one.bias(reader)], yerr=[one.read[reader].error],
                          markerfacecolor="white", linewidth=0.9, **spot)  # fmt: skip
    axes.set(xscale="log")
    style.plain_numbers(axes.xaxis)


def _label(one: ImpactExponents) -> str:
    impact = one.impact
    return f"E_i/E_inf = {impact.ratio:g}" if impact.wide is None else f"a/h = {impact.wide:g}"
