"""The chart of a trade-off: error over processor time and over counted work, the front, the planned defaults.

Colours tell schemes or orders apart, markers masses; every exact law has a sign of its own.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, LogFormatterMathtext, LogLocator, NullFormatter

from fe_contact.studies import style
from fe_contact.studies.history_chart import caption
from fe_contact.studies.style import Look
from fe_contact.studies.tradeoff.point import Point
from fe_contact.studies.tradeoff.study import Tradeoff
from fe_contact.studies.tradeoff.tried import ROW
from fe_contact.studies.tradeoff.verdict import Measure, finite_elements, front, judged, known_to

PANELS = 3.9  # height of the panels, in
LEAST, MOST = 1e-9, 1.0  # what lies beyond is drawn at the ends of the error axis
COLUMNS, ROW_HEIGHT = 4, 0.185  # of the legend; height of a row, in
FEW_DECADES = 1.5  # of an axis below which powers of ten are too few ticks
COLOURS = (style.BLUE, style.GREEN, style.ORANGE, style.SKY, style.BLACK, style.VERMILION)
MARKERS = ("o", "s", "^", "v")
ERROR = "error (the largest of peak, duration, restitution, history)"
ALL_METHODS = "front of all methods"
STAR: Look = {"color": "#F0E442", "markeredgecolor": style.BLACK, "markeredgewidth": 0.7}
EXACT: tuple[Look, ...] = (
    {"color": style.BLACK, "marker": "^"},
    {"color": style.PURPLE, "marker": "s"},
    {"color": style.VERMILION, "marker": "v"},
)
SPRINGS: Look = {"color": style.PURPLE, "marker": "D", "label": "row of springs, 25 to 400"}
OTHERS: Look = {
    "color": style.VERMILION,
    "marker": "x",
    "label": "laws that leave something out",
    "markeredgewidth": 0.9,
}


def plot_tradeoff(found: Tradeoff, where: Path) -> tuple[Path, Path]:
    """Write ``tradeoff.svg`` and ``tradeoff.png`` into the folder ``where``; their paths."""
    scene, points, lines = found.scene, found.points, list(found.verdict)
    signs, laws = Signs.of(points), looks(points)
    legend = [
        *signs.legend(points),
        *(_sign(**look) for look in {look["label"]: look for look in laws.values()}.values()),
    ]
    title = f"What accuracy costs: {scene.name}"
    below = 0.61 + ROW_HEIGHT * -(-len(legend) // COLUMNS)
    with style.sheet(where, "tradeoff", title, lines, PANELS, above=0.3, below=below) as sheet:
        if finite_elements(points):
            left, right = sheet.panels(1, 2, 0.082, 0.985, wspace=0.24, width_ratios=(1.3, 1.0))
            _counted(right, points, signs)
            style.label(right, "b", "finite elements: error over counted work")
        else:
            (left,) = sheet.panels(1, 1, 0.082, 0.985)
        _every_method(left, points, signs, laws)
        place = 0.075, 0.24 / sheet.figure.get_figheight()
        sheet.figure.legend(handles=legend, loc="lower left", bbox_to_anchor=place, ncols=COLUMNS, columnspacing=1.6,
                            handletextpad=0.5, labelspacing=0.55, borderaxespad=0.0)  # fmt: skip
        style.footnote(sheet.figure, caption(scene))
    return sheet.paths


def plot_work(found: Tradeoff, lines: list[str], where: Path) -> None:
    """Write ``work.svg`` and ``work.png`` into ``where``, finite elements over counted work alone: the same on every
    machine.
    """
    signs = Signs.of(found.points)
    with style.sheet(where, "work", f"What accuracy costs: {found.scene.name}", lines, PANELS) as sheet:
        (axes,) = sheet.panels(1, 1, 0.082, 0.68)
        _counted(axes, found.points, signs)
        axes.set_ylabel(ERROR)
        legend = [sign for sign in signs.legend(found.points) if sign.get_label() != ALL_METHODS]
        axes.legend(handles=legend, loc="upper left", bbox_to_anchor=(1.03, 1.0), labelspacing=0.8)


def _counted(axes: Axes, points: Sequence[Point], signs: Signs) -> None:
    _finite_elements(axes, points, signs, lambda point: point.work["operations"])
    axes.set(xlabel="counted work, operations", ylabel="error")
    ticks(axes)


def looks(points: Sequence[Point]) -> dict[str, Look]:
    """Of every law: an exact one, which was asked for several tolerances, has its own; all others share one."""
    counts = Counter(point.method for point in judged(points) if point.method != "fe")
    exact = [name for name, count in counts.items() if count > 1 and name != ROW]
    own = {name: {**look, "label": f"{name}, to its bar"} for name, look in zip(exact, EXACT, strict=False)}
    return {name: SPRINGS if name == ROW else own.get(name, OTHERS) for name in counts}


def _every_method(axes: Axes, points: Sequence[Point], signs: Signs, laws: Mapping[str, Look]) -> None:
    _finite_elements(axes, points, signs, _processor_time)
    for method, look in laws.items():
        own = [point for point in judged(points) if point.method == method]
        cost, error = [point.cpu for point in own], [_drawn(point.error) for point in own]
        axes.plot(cost, error, linestyle="-", linewidth=0.7, **{"markersize": 4.0, "markeredgewidth": 0.0, **look})
    _front(axes, judged(points), _processor_time, color=style.BLACK, linestyle="--")
    axes.set(xlabel="processor time, s", ylabel=ERROR)
    ticks(axes)
    style.label(axes, "a", "every method: error over processor time")


def _processor_time(point: Point) -> float:
    return point.cpu


def _front(axes: Axes, points: Sequence[Point], cost: Measure, **look: Any) -> None:
    """The steps below which no point lies."""
    best = front(points, cost, lambda point: _drawn(point.error))
    steps = [cost(p) for p in best], [_drawn(p.error) for p in best]
    axes.step(*steps, where="post", zorder=2, **{"linewidth": 0.9, **look})


def ticks(axes: Axes) -> None:
    """Powers of ten, about eight at most; where an axis spans few of them, plain numbers far enough from each other."""
    for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
        axis.set_minor_formatter(NullFormatter())
        if np.log10(high / low) < FEW_DECADES:
            axis.set_major_locator(FixedLocator(_round_numbers(low, high)))
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.2g}"))
        else:
            axis.set_major_locator(LogLocator(numticks=8))
            axis.set_major_formatter(LogFormatterMathtext())


def _round_numbers(low: float, high: float) -> list[float]:
    """1, 2 and 5 of every power of ten between two numbers; where there are no two of them, their middle."""
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    found = [one for one in (digit * 10.0**power for power in powers for digit in (1, 2, 5)) if low <= one <= high]
    return found if len(found) > 1 else [float(f"{math.sqrt(low * high):.2g}")]


def _finite_elements(axes: Axes, points: Sequence[Point], signs: Signs, cost: Measure) -> None:
    """Points with a whisker up to the claimed bar; the front, the defaults, what the reference is known to."""
    tried = finite_elements(points)
    for point in tried:
        look, error = signs.of_point(point), _drawn(point.error)
        if point.bar is not None:
            axes.vlines(cost(point), error, _drawn(point.bar), color=look["color"], linewidth=0.7, alpha=0.4, zorder=1)
        axes.plot([cost(point)], [error], linestyle="", markersize=3.6, markeredgewidth=0.8, zorder=3, **look)
    _front(axes, tried, cost, color=style.GREY)
    axes.axhline(_drawn(known_to(points)), color=style.BLACK, linewidth=0.7, linestyle=":", zorder=1)
    defaults = [point for point in tried if point.default_for is not None]
    for error in {point.error for point in defaults}:
        _default(axes, [point for point in defaults if point.error == error], cost)
    axes.set(xscale="log", yscale="log")
    axes.margins(y=0.12)
    axes.grid(which="major", color="#e6e6e6", linewidth=0.5)
    axes.set_axisbelow(True)


def _default(axes: Axes, alike: Sequence[Point], cost: Measure) -> None:
    """Stars of one choice of settings, and away from them the tolerances it is for."""
    error, costs = _drawn(alike[0].error), [cost(point) for point in alike]
    axes.plot(costs, [error] * len(costs), "*", markersize=10.0, zorder=4, **STAR)
    leader = {"arrowstyle": "-", "linewidth": 0.6, "color": style.BLACK, "shrinkA": 0.0, "shrinkB": 4.0}
    tolerances = ", ".join(_power(point.default_for or 0.0) for point in alike)
    axes.annotate(tolerances, (min(costs), error), (-46.0, -16.0), ha="right", textcoords="offset points",
                  arrowprops=leader, zorder=5)  # fmt: skip


def _drawn(error: float) -> float:
    """An error within the axis."""
    return min(max(error, LEAST), MOST)


def _power(tolerance: float) -> str:
    """A tolerance as a power of ten where it is one."""
    exponent = np.log10(tolerance)
    return f"$10^{{{exponent:.0f}}}$" if abs(exponent - round(exponent)) < 1e-9 else f"{tolerance:g}"


@dataclass(frozen=True)
class Signs:
    """``colours`` by the value of the setting ``key``, ``markers`` by mass."""

    key: str
    colours: dict[object, str]
    markers: dict[object, str]

    @classmethod
    def of(cls, points: Sequence[Point]) -> Signs:
        """By scheme where several were tried, else by order; the highest or first in the first colour."""
        tried = finite_elements(points)
        found = {key: {point.settings.get(key) for point in tried} for key in ("scheme", "order", "mass")}
        several = len(found["scheme"]) > 1
        key = "scheme" if several else "order"
        colours = dict(zip(sorted(found[key], key=str, reverse=not several), COLOURS, strict=False))
        return cls(key, colours, dict(zip(sorted(found["mass"], key=str), MARKERS, strict=False)))

    def of_point(self, point: Point) -> Look:
        """Marker and colours of a point of finite elements; hollow with a raw penalty."""
        colour = self.colours[point.settings[self.key]]
        raw = point.settings["enforcement"] == "penalty"
        face = "white" if raw else colour
        return {"marker": self.markers[point.settings.get("mass")], "color": colour, "markerfacecolor": face}

    def legend(self, points: Sequence[Point]) -> list[Line2D]:
        """What the signs of finite elements mean, the fronts and the bar of what errors are measured from."""
        found, line = list[Line2D](), partial(Line2D, [], [])
        if tried := finite_elements(points):
            for value, colour in self.colours.items():
                name = f"elements of order {value}" if self.key == "order" else _said(value)
                found.append(_sign("o", colour, name))
            if len(self.markers) > 1:
                found += [_sign(marker, style.GREY, f"mass: {_said(mass)}") for mass, marker in self.markers.items()]
            if any(point.settings["enforcement"] == "penalty" for point in tried):
                found.append(_sign("o", style.GREY, "raw penalty", markerfacecolor="white"))
            found.append(line(color=style.GREY, linewidth=0.9, label="front of finite elements"))
            found.append(_sign("|", style.GREY, "up to the claimed error bar", markersize=9.0))
            found.append(_sign("*", label="default for a tolerance", markersize=9.0, **STAR))
        found.append(line(color=style.BLACK, linewidth=0.9, linestyle="--", label=ALL_METHODS))
        found.append(line(color=style.BLACK, linewidth=0.7, linestyle=":", label="bar of the truth"))
        return found


def _said(name: object) -> str:
    return str(name).replace("_", " ")


def _sign(marker: str, color: str, label: str, **look: Any) -> Line2D:
    return Line2D([], [], linestyle="", marker=marker, color=color, label=label, **{"markersize": 4.5, **look})
