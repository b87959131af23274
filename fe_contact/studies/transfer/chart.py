"""The chart of a transfer: a panel a quantity, a curve a law with its name beside it; and how far each law holds.

Curves that are one, to what a reader sees, share a name.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from fe_contact.studies import style
from fe_contact.studies.style import Look
from fe_contact.studies.transfer.study import TransferStudy
from fe_contact.studies.transfer.verdict import LEVELS, QUANTITIES, TransferRow, TransferVerdict, holds, percent
from lumped.materials import Material
from lumped.materials.networks import NETWORKS
from lumped.numbers import Array
from lumped.scene.tables import LAWS, STRIKER_KEYS, TARGET_KEYS, Model, Motion
from lumped.schema.keys import Described, Key, Number, keys_of
from lumped.shapes import SHAPES
from lumped.targets import TARGETS

COLUMNS, PANEL, BETWEEN = 2, 1.75, 0.62  # panels in a row; height of one and of what is between two, in
LINEAR = 1.0  # %, up to which the axis is linear: the finest level a law may be asked for
MOST = 300.0  # %, what lies beyond is drawn at the end of the axis
TICKS = (-100.0, -10.0, -1.0, 0.0, 1.0, 10.0, 100.0)  # look: %
ALIKE = 0.012  # look: of the axis, by which curves may differ that share a name
LINE = 0.072  # look: of the axis, between two names
APART = 0.13  # look: of the axis, between two ticks
NAMES, WIDE, LEADING = 5.3, 28, 1.25  # look: size of a name; characters beside a panel; between its lines
BROAD = {0.1: 0.22, 0.05: 0.5, 0.01: 1.0}  # look: how strong the bar of each level is


def plot_transfer(study: TransferStudy, where: Path) -> tuple[Path, ...]:
    """Write ``transfer.svg`` and ``transfer.png`` into a folder; further keys have theirs in the name. The paths."""
    paths = list[Path]()
    for i, key in enumerate(study.keys):
        paths += _plot(study, key, where, "transfer" if i == 0 else f"transfer-{key}")
    return tuple(paths)


def _plot(study: TransferStudy, key: str, where: Path, name: str) -> tuple[Path, ...]:
    rows = [row for row in study.rows if row.key == key and row.verdict is not TransferVerdict.REFUSED]
    lines = [
        f"Every law calibrated by {study.asked.calibrate.replace('_', ' ')} at {study.at} (dotted): its prediction "
        f"less the reference ({study.reference.method}), whose error bar is shaded. Lines at 1, 5 and 10 %."
    ]
    count = -(-(len(QUANTITIES) + 1) // COLUMNS)
    height = count * PANEL + (count - 1) * BETWEEN
    title = f"{study.name}: laws used at another {key}"
    with style.sheet(where, name, title, lines, height, above=0.3) as sheet:
        panels = sheet.panels(count, COLUMNS, 0.078, 0.845, wspace=0.74, hspace=BETWEEN / PANEL)
        for i, (axes, quantity) in enumerate(zip(panels, QUANTITIES, strict=False)):
            _deviations(axes, [row for row in rows if row.quantity == quantity])
            style.label(axes, chr(ord("a") + i), f"{quantity.replace('_', ' ')} (linear to {LINEAR:g})")
            _states(axes, study, key, rows)
        _ranges(panels[len(QUANTITIES)], study, key, rows)
        style.label(panels[len(QUANTITIES)], chr(ord("a") + len(QUANTITIES)), "all within")
        _states(panels[len(QUANTITIES)], study, key, rows)
    return sheet.paths


def with_unit(key: str) -> str:
    """A dotted key of a scene with its unit, where it has one: that of all shapes, networks or laws alike."""
    part, _, name = key.rpartition(".")
    every = {
        "striker": [STRIKER_KEYS, *_sets(SHAPES.members)],
        "target": [TARGET_KEYS, *_sets(TARGETS.members)],
        "striker.material": [keys_of(Material), *_sets(NETWORKS.members)],
        "target.material": [keys_of(Material), *_sets(NETWORKS.members)],
        "model": [keys_of(Model)],
        "motion": [keys_of(Motion)],
        "law": _sets(LAWS.members),
    }
    kinds = [keys[name].kind for keys in every.get(part, []) if name in keys]
    units = {kind.unit for kind in kinds if isinstance(kind, Number)} - {"", "1"}
    return f"{key}, {units.pop()}" if len(units) == 1 else key


def _sets(members: Mapping[str, Described]) -> list[Mapping[str, Key]]:
    return [keys for one in members.values() for keys in one.sets]


def _states(axes: Axes, study: TransferStudy, key: str, rows: Sequence[TransferRow]) -> None:
    """The axis of the states, logarithmic, with a tick at that of calibration and at others as far as there is room."""
    values = sorted({state.value for state in study.states if state.key == key})
    axes.set(xscale="log", xlabel=with_unit(key))
    ticks = list[float]()
    for value in (study.start[key], *values):
        if all(abs(math.log(value / tick)) >= APART * math.log(values[-1] / values[0]) for tick in ticks):
            ticks.append(value)
    axes.xaxis.set_major_locator(FixedLocator(ticks))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.3g}"))
    axes.axvline(study.start[key], color=style.GREY, linewidth=0.6, linestyle=(0, (1, 2)), zorder=0)
    if values[0] < values[-1]:
        axes.set_xlim(values[0], values[-1])


def _deviations(axes: Axes, rows: Sequence[TransferRow]) -> None:
    """Deviations in %, of the restitution in hundredths."""
    curves = {law: _curve(rows, law) for law in dict.fromkeys(row.law for row in rows)}
    axes.set_yscale("symlog", linthresh=LINEAR)
    axes.yaxis.set_major_locator(FixedLocator(TICKS))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:+g}" if value else "0"))
    known = np.concatenate([deviation for _, deviation in curves.values()] or [np.zeros(1)])
    most = min(1.5 * max(float(np.nanmax(np.abs(known), initial=0.0)), 1.2 * LINEAR), MOST)
    absolute = any(row.quantity == "restitution" for row in rows)
    axes.set(ylim=(-most, most), ylabel="difference, hundredths" if absolute else "deviation, %")
    for level in LEVELS:
        for sign in (-1.0, 1.0):
            axes.axhline(sign * 100.0 * level, color=style.GREY, linewidth=0.35, alpha=0.6, zorder=0)
    values, bars = _bars(rows)
    axes.fill_between(values, -bars, bars, color=style.SKY, alpha=0.45, linewidth=0.0, zorder=1)
    for law, (places, deviation) in curves.items():
        axes.plot(places, np.clip(deviation, -MOST, MOST), color=style.law_colour(law), marker="o", markersize=1.8,
                  linewidth=1.0)  # fmt: skip
    _name(axes, curves)


def _curve(rows: Sequence[TransferRow], law: str) -> tuple[Array, Array]:
    """States and deviations of a law, %, NaN where there is none."""
    own = [row for row in rows if row.law == law]
    deviations = [np.nan if row.deviation is None else 100.0 * row.deviation for row in own]
    return np.array([row.value for row in own]), np.array(deviations)


def _bars(rows: Sequence[TransferRow]) -> tuple[Array, Array]:
    """States, and the reference's bar there, %, as a deviation."""
    bars = dict[float, float]()
    for row in rows:
        size = 1.0 if row.quantity == "restitution" else abs(row.reference or 0.0)
        bars[row.value] = 100.0 * (row.reference_error or 0.0) / size if size else 0.0
    values = sorted(bars)
    return np.array(values), np.array([bars[value] for value in values])


def _name(axes: Axes, curves: dict[str, tuple[Array, Array]]) -> None:
    """Names at the right of a panel, each as near to the end of its curve as the others leave room for."""
    drawn = reversed(curves.items())  # of curves that are one the last is seen, and gives the name its colour
    ends = [(law, _height(axes, deviation)) for law, (_, deviation) in drawn if np.isfinite(deviation).any()]
    groups: list[tuple[list[str], Array]] = []
    for law, heights in ends:
        known = next((one for one in groups if _alike(one[1], heights)), None)
        if known is None:
            groups.append(([law], heights))
        else:
            known[0].append(law)
    groups.sort(key=lambda group: float(group[1][-1]))
    said = [textwrap.fill(", ".join(names), WIDE, break_on_hyphens=False) for names, _ in groups]
    sizes = LINE * np.array([1.0 + text.count("\n") for text in said])
    wanted = np.array([heights[-1] for _, heights in groups])
    for (names, heights), text, place in zip(groups, said, spread(wanted, sizes), strict=True):
        look: Look = {"color": style.law_colour(names[0]), "linewidth": 0.4, "clip_on": False}
        axes.plot([1.0, 1.05], [heights[-1], place], transform=axes.transAxes, **look)
        axes.text(1.06, place, text, transform=axes.transAxes, color=style.law_colour(names[0]),
                  fontsize=NAMES, va="center", linespacing=LEADING)  # fmt: skip


def _height(axes: Axes, deviation: Array) -> Array:
    """Where deviations lie, in shares of the panel; the last one known is the end."""
    known = np.clip(deviation[np.isfinite(deviation)], *axes.get_ylim())
    places = axes.transData.transform(np.column_stack([np.ones_like(known), known]))
    return np.asarray(axes.transAxes.inverted().transform(places)[:, 1])


def _alike(one: Array, other: Array) -> bool:
    return one.size == other.size and bool(np.abs(one - other).max() < ALIKE)


def spread(wanted: Array, sizes: Array) -> Array:
    """Middles of things of these sizes, one above the other in their order, near those wanted and below 1."""
    places, apart = wanted.copy(), 0.5 * (sizes[1:] + sizes[:-1])
    for i in range(1, places.size):
        places[i] = max(places[i], places[i - 1] + apart[i - 1])
    top = 1.0 + 0.5 * LINE
    for i in range(places.size - 1, -1, -1):
        places[i] = min(places[i], top - 0.5 * sizes[i])
        top = places[i] - 0.5 * sizes[i]
    return places


def _ranges(axes: Axes, study: TransferStudy, key: str, rows: Sequence[TransferRow]) -> None:
    """A line a law: the range over which all quantities are held to every level, the finest the strongest."""
    names = list(dict.fromkeys(row.law for row in rows))
    for place, law in enumerate(names):
        reach = holds([row for row in rows if row.law == law], study.start[key])["all"]
        for level in sorted(LEVELS, reverse=True):
            ends = reach[percent(level)]
            if ends is not None:
                axes.plot(ends, [place, place], color=style.law_colour(law), alpha=BROAD[level], linewidth=3.4,
                          solid_capstyle="butt")  # fmt: skip
                axes.plot(study.start[key], place, "o", color=style.law_colour(law), markersize=1.8)
        axes.text(1.03, place, law, transform=axes.get_yaxis_transform(), color=style.law_colour(law),
                  fontsize=NAMES, va="center")  # fmt: skip
    axes.set(ylim=(len(names) - 0.4, -0.6), yticks=[])
    axes.spines["left"].set_visible(False)
    _key(axes)


def _key(axes: Axes) -> None:
    """The shade of every level, over those of the coarser ones as in the panel, beside its title."""
    shades = [
        tuple(Patch(color=style.BLACK, alpha=BROAD[one], linewidth=0.0) for one in LEVELS if one >= level)
        for level in LEVELS
    ]
    axes.legend(shades, [f"{100.0 * level:g} %" for level in LEVELS], ncols=len(LEVELS), loc="lower right",
                bbox_to_anchor=(1.0, 0.98), fontsize=NAMES, handlelength=1.2, columnspacing=1.0)  # fmt: skip
