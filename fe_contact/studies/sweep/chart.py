"""The chart of a sweep: curves over one axis, maps over two, else how quantities scatter and what they follow."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from fe_contact.studies import style
from fe_contact.studies.style import Look
from fe_contact.studies.sweep.cases import Axis, Sweep
from fe_contact.studies.sweep.table import LEAST_RANKED, SweepTable
from lumped.numbers import Array
from lumped.result.result import UNITS

QUANTITIES = ("peak_force", "peak_depth", "duration", "restitution")
MAPPED = ("restitution", "peak_force")
NAME = "sweep"  # of the files
INSIDE = 0.48  # look: of a map's width and height from its middle, where a number is not cut by the frame
EVEN = 1e-6  # rounding: of steps between values that were spaced evenly
LEVELS, BINS = 9, 24  # look: lines of a map at most; bars of a histogram at most
ABOVE, ROW, NAMES = 0.35, 0.17, 5  # look: in, above the panels without a legend; a row of that, in, and names in one
WIDE, THIN = 2.6, 1.0  # look: of the first method's curve and the last one's, so that none hides another, pt


def plot_sweep(table: SweepTable, where: Path) -> tuple[Path, ...]:
    """Write ``sweep.svg`` and ``sweep.png`` into the folder ``where``; their paths, none where no number varies."""
    varied = [axis for axis in table.sweep.axes if len(axis.places) > 1]
    numbers = [key for axis in varied if (key := _number(table, axis))]
    if not numbers:
        return ()
    plain = len(numbers) == len(varied) and not any(axis.drawn for axis in varied)
    draw = {1: _curves, 2: _maps}.get(len(varied), _scatter) if plain else _scatter
    return draw(table, numbers, where)


def _number(table: SweepTable, axis: Axis) -> str:
    """The first key of an axis that is a number and varies; empty where there is none."""
    return next((key for key in axis.keys if key in table.numbers and np.ptp(table.numbers[key]) > 0.0), "")


def _column(table: SweepTable, quantity: str, method: int, what: Array) -> Array:
    """Values, or bars, of a quantity by a method, (cases,); NaN where the answer did not converge."""
    return np.where(table.converged[:, method], what[:, method, list(UNITS).index(quantity)], np.nan)


def _scale(quantity: str, values: Array) -> tuple[float, str]:
    """Factor of an axis, and its name with the unit."""
    known, name = np.abs(values[np.isfinite(values)]), quantity.replace("_", " ")
    if UNITS[quantity] == "1" or not known.size:
        return 1.0, name
    factor, unit = style.prefixed(float(known.max()), UNITS[quantity])
    return factor, f"{name}, {unit}"


def _geometric(values: Array) -> bool:
    """Whether values, sorted and each once, have equal ratios rather than equal steps, or span more than a decade."""
    if values[0] <= 0.0 or values.size < 3:
        return bool(_decades(values))
    steps, ratios = np.diff(values), np.diff(np.log(values))
    even = np.ptp(steps) <= EVEN * steps.max()
    return not even and (_decades(values) or bool(np.ptp(ratios) <= EVEN * ratios.max()))


def _decades(values: Array) -> bool:
    """Whether values are positive and span more than a decade; those that are not finite count for nothing."""
    known = values[np.isfinite(values)]
    return bool(known.size and known.max() > 10.0 * known.min() > 0.0)


def _scaled(key: str, values: Array, to_scale: Callable[[str], object], to_label: Callable[[str], object]) -> None:
    """An axis over a key of the scene."""
    to_label(key)
    if _geometric(np.unique(values)):
        to_scale("log")


def _colour(method: int) -> str:
    return style.CYCLE[method % len(style.CYCLE)]


def _curves(table: SweepTable, numbers: list[str], where: Path) -> tuple[Path, ...]:
    """Quantities over the one key, a colour a method, with the bands of their bars."""
    sweep, (key,) = table.sweep, numbers
    text = ["Bands: error bars. Answers that did not converge, or were refused, are left out. SI units."]
    unknown = [name for name, converged in zip(sweep.methods, table.converged.T, strict=True) if not converged.any()]
    text += [f"Without an answer: {', '.join(unknown)}."] if unknown else []
    with style.sheet(where, NAME, _title(sweep), text, 3.9) as sheet:
        for place, axes in enumerate(sheet.panels(2, 2, 0.075, 0.985, wspace=0.24, hspace=0.34)):
            _panel(axes, table, key, QUANTITIES[place])
            style.label(axes, "abcd"[place], QUANTITIES[place].replace("_", " "))
            axes.set_xlabel(key if place > 1 else "")
        sheet.figure.axes[0].legend()
    return sheet.paths


def _panel(axes: Axes, table: SweepTable, key: str, quantity: str) -> None:
    order = np.argsort(table.numbers[key], kind="stable")
    x = table.numbers[key][order]
    values = [_column(table, quantity, method, table.values)[order] for method in range(len(table.sweep.methods))]
    factor, name = _scale(quantity, np.array(values))
    for method, column in enumerate(values):
        if not table.converged[:, method].any():
            continue
        bars = _column(table, quantity, method, table.errors)[order]
        width = WIDE + (THIN - WIDE) * method / max(len(values) - 1, 1)
        look: Look = {"color": _colour(method), "marker": "o", "markersize": 1.8 * width, "linewidth": width}
        axes.plot(x, factor * column, label=table.sweep.methods[method], **look)
        axes.fill_between(
            x, factor * (column - bars), factor * (column + bars), color=_colour(method), alpha=0.25, lw=0
        )
    _scaled(key, x, axes.set_xscale, axes.set_xlabel)
    axes.set_ylabel(name)
    if _decades(np.array(values)):
        axes.set_yscale("log")
    style.plain_numbers(axes.xaxis, axes.yaxis)


def _maps(table: SweepTable, numbers: list[str], where: Path) -> tuple[Path, ...]:
    """Two quantities over two keys, by the first method: the first key upwards, the second to the right."""
    sweep, method = table.sweep, table.sweep.methods[0]
    text = [f"By the method {method}. White: an answer did not converge, or was refused. SI units."]
    with style.sheet(where, NAME, _title(sweep), text, 2.7) as sheet:
        for place, axes in enumerate(sheet.panels(1, 2, 0.1, 0.965, wspace=0.34)):
            _map(axes, table, numbers, MAPPED[place])
            style.label(axes, "ab"[place], _scale(MAPPED[place], _column(table, MAPPED[place], 0, table.values))[1])
    return sheet.paths


def _map(axes: Axes, table: SweepTable, numbers: list[str], quantity: str) -> None:
    y, x = (np.unique(table.numbers[key]) for key in numbers)
    column = _column(table, quantity, 0, table.values)
    values = np.full((y.size, x.size), np.nan)
    values[tuple(np.searchsorted(np.unique(table.numbers[key]), table.numbers[key]) for key in numbers)] = column
    values *= _scale(quantity, column)[0]
    known = values[np.isfinite(values)]
    _scaled(numbers[1], x, axes.set_xscale, axes.set_xlabel)
    _scaled(numbers[0], y, axes.set_yscale, axes.set_ylabel)
    style.plain_numbers(axes.xaxis, axes.yaxis)
    axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    if known.size and np.ptp(known) > EVEN * np.abs(known).max():
        shown = np.ma.masked_invalid(values)
        look: Look = {"levels": _levels(known), "norm": "log" if _decades(known) else "linear"}
        axes.contourf(x, y, shown, cmap="cividis", alpha=0.75, **look)
        lines = axes.contour(x, y, shown, levels=look["levels"], colors=style.BLACK, linewidths=0.6)
        for label in axes.clabel(lines, fontsize=6.0, fmt="%g"):
            place = (axes.transData - axes.transAxes).transform(label.get_position())
            label.set_visible(bool(np.abs(place - 0.5).max() < INSIDE))


def _levels(known: Array) -> Array:
    """Round values from below the least to above the largest."""
    low, high = float(known.min()), float(known.max())
    if _decades(known):
        powers = 10.0 ** np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1.0)
        ticks = np.outer(powers, (1.0, 2.0, 5.0)).ravel() if powers.size < LEVELS else powers
    else:
        ticks = np.asarray(MaxNLocator(LEVELS).tick_values(low, high))
    return ticks[max(0, int(np.searchsorted(ticks, low, "right")) - 1) : int(np.searchsorted(ticks, high)) + 1]


def _scatter(table: SweepTable, numbers: list[str], where: Path) -> tuple[Path, ...]:
    """How every quantity is distributed over all cases, and which key it follows."""
    keys = [key for key, column in table.numbers.items() if np.ptp(column) > 0.0]
    text = [
        "Above: answers that converged, of all cases, by value. Below: Spearman's rank correlation of each quantity "
        "with each key; 1 or -1 where the quantity grows or falls with it alone, no bar where either takes fewer than "
        f"{LEAST_RANKED} values."
    ]
    left = min(0.4, 0.03 + 0.0085 * max(map(len, keys)))
    height = 0.18 * len(keys) * len(table.sweep.methods) + 0.25
    methods = len(table.sweep.methods)
    above = ABOVE + (ROW * math.ceil(methods / NAMES) if methods > 1 else 0.0)
    with style.sheet(where, NAME, _title(table.sweep), text, 2.1 + height, above=above) as sheet:
        look: Look = {"wspace": 0.16, "hspace": 0.95 / (1.0 + height), "height_ratios": [1.55, height]}
        panels = sheet.panels(2, len(QUANTITIES), left, 0.985, **look)
        for place, quantity in enumerate(QUANTITIES):
            _histogram(panels[place], table, quantity)
            style.label(panels[place], "abcd"[place], quantity.replace("_", " "))
            _ranks(panels[len(QUANTITIES) + place], table, keys, quantity)
            if place:
                panels[len(QUANTITIES) + place].set_yticklabels([])
        if methods > 1:  # above the titles: there is no place between bars
            corner = (left, sheet.top + 0.8 * ABOVE / sheet.figure.get_figheight())
            names = panels[0].get_legend_handles_labels()
            sheet.figure.legend(*names, loc="lower left", bbox_to_anchor=corner, ncols=NAMES, borderaxespad=0.0)
    return sheet.paths


def _histogram(axes: Axes, table: SweepTable, quantity: str) -> None:
    columns = [_column(table, quantity, method, table.values) for method in range(len(table.sweep.methods))]
    factor, name = _scale(quantity, np.array(columns))
    known = [factor * column[np.isfinite(column)] for column in columns]
    everything = np.concatenate(known)
    if everything.size:
        edges = np.histogram_bin_edges(everything, min(BINS, max(4, round(2.0 * everything.size ** (1 / 3)))))
        for method, column in enumerate(known):
            look: Look = {"color": _colour(method), "label": table.sweep.methods[method]}
            axes.hist(column, edges.tolist(), histtype="stepfilled", alpha=0.3, **look | {"label": None})
            axes.hist(column, edges.tolist(), histtype="step", **look)
    axes.set(xlabel=name, yticks=[])
    axes.spines["left"].set_visible(False)


def _ranks(axes: Axes, table: SweepTable, keys: list[str], quantity: str) -> None:
    methods = len(table.sweep.methods)
    for method in range(methods):
        ranks = table.ranks(method, list(UNITS).index(quantity))
        places = np.arange(len(keys)) + (method - (methods - 1) / 2) * 0.8 / methods
        axes.barh(places, [ranks.get(key, 0.0) for key in keys], 0.7 / methods, color=_colour(method))
    axes.axvline(0.0, color=style.GREY, linewidth=0.6)
    axes.set(xlim=(-1.0, 1.0), xticks=[-1.0, 0.0, 1.0], yticks=range(len(keys)), yticklabels=keys, xlabel="correlation")
    axes.invert_yaxis()


def _title(sweep: Sweep) -> str:
    return f"{sweep.name}: {sweep.count} cases"
