"""The chart of a trade-off: error over processor time and over counted work, the front, the planned defaults.

The signs of a trade-off's chart: colours for schemes or orders, markers for masses, one each for every law.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from fe_contact.studies import style
from fe_contact.studies.history_chart import caption
from fe_contact.studies.style import Look
from fe_contact.studies.tradeoff.point import Point
from fe_contact.studies.tradeoff.study import Measure, finite_elements, front, known_to, verdict
from lumped.scene.scene import Scene

PANELS = 3.9  # height of the panels, in
TITLE_WIDTH = 130  # characters
LEAST, MOST = 1e-9, 1.0  # what lies beyond is drawn at the ends of the error axis
COLUMNS, ROW = 4, 0.185  # of the legend; height of a row, in
COLOURS = (style.BLUE, style.GREEN, style.ORANGE, style.SKY, style.BLACK, style.VERMILION)
MARKERS = ("o", "s", "^", "v")
STAR: Look = {"color": "#F0E442", "markeredgecolor": style.BLACK, "markeredgewidth": 0.7}
LAWS: dict[str, Look] = {
    "mdr row": {"color": style.PURPLE, "marker": "D", "label": "row of springs, 25 to 400"},
    "mdr": {"color": style.PURPLE, "marker": "s", "label": "mdr, to its bar"},
    "ting": {"color": style.BLACK, "marker": "^", "label": "ting, to its bar"},
    "rod_waves": {"color": style.PURPLE, "marker": "s", "label": "rod_waves, to its bar"},
    "hertz": {"color": style.VERMILION, "marker": "X", "label": "hertz"},
    "correspondence": {"color": style.VERMILION, "marker": "P", "label": "correspondence"},
}


def plot_tradeoff(scene: Scene, points: Sequence[Point], where: Path) -> tuple[Path, Path]:
    """Write ``tradeoff.svg`` and ``tradeoff.png`` into the folder ``where``; their paths."""
    lines, signs = list(verdict(points)), Signs.of(points)
    legend = signs.legend(points)
    title, room = f"What accuracy costs: {scene.name}", {"above": 0.3, "below": 0.61 + ROW * -(-len(legend) // COLUMNS)}
    with style.sheet(where, "tradeoff", title, lines, PANELS, width=TITLE_WIDTH, **room) as sheet:
        left, right = sheet.panels(1, 2, 0.082, 0.985, wspace=0.24, width_ratios=(1.3, 1.0))
        _every_method(left, points, signs)
        _finite_elements(right, points, signs, lambda point: point.work["operations"])
        right.set(xlabel="counted work, operations", ylabel="error")
        style.label(right, "b", "finite elements: error over counted work")
        place = 0.075, 0.24 / sheet.figure.get_figheight()
        sheet.figure.legend(handles=legend, loc="lower left", bbox_to_anchor=place, ncols=COLUMNS, columnspacing=1.6,
                            handletextpad=0.5, labelspacing=0.55, borderaxespad=0.0)  # fmt: skip
        style.footnote(sheet.figure, caption(scene))
    return sheet.paths


def _every_method(axes: Axes, points: Sequence[Point], signs: Signs) -> None:
    for method, look in LAWS.items():
        own = [point for point in points if point.method == method and not point.failure]
        cost, error = [point.cpu for point in own], [_drawn(point.error) for point in own]
        axes.plot(cost, error, linestyle="-", linewidth=0.7, markersize=4.0, markeredgewidth=0.0, **look)
    _finite_elements(axes, points, signs, lambda point: point.cpu)
    axes.set(xlabel="processor time, s", ylabel="error (the largest of peak, duration, restitution, history)")
    style.label(axes, "a", "every method: error over processor time")


def _finite_elements(axes: Axes, points: Sequence[Point], signs: Signs, cost: Measure) -> None:
    """Points with a whisker up to the claimed bar; the front, the defaults, what the reference is known to."""
    tried = finite_elements(points)
    for point in tried:
        look, error = signs.of_point(point), _drawn(point.error)
        if point.bar is not None:
            axes.vlines(cost(point), error, _drawn(point.bar), color=look["color"], linewidth=0.7, alpha=0.4, zorder=1)
        axes.plot([cost(point)], [error], linestyle="", markersize=3.6, markeredgewidth=0.8, zorder=3, **look)
    best = front(tried, cost, lambda point: _drawn(point.error))
    steps = [cost(p) for p in best], [_drawn(p.error) for p in best]
    axes.step(*steps, where="post", color=style.GREY, linewidth=0.9, zorder=2)
    if known_to(points):
        axes.axhline(known_to(points), color=style.BLACK, linewidth=0.7, linestyle=":", zorder=1)
    for point in tried:
        if point.default_for is not None:
            _default(axes, cost(point), _drawn(point.error), point.default_for)
    axes.set(xscale="log", yscale="log")
    axes.margins(y=0.12)
    axes.grid(which="major", color="#e6e6e6", linewidth=0.5)
    axes.set_axisbelow(True)


def _default(axes: Axes, cost: float, error: float, tolerance: float) -> None:
    """A star, and away from it the tolerance it is for."""
    axes.plot([cost], [error], "*", markersize=10.0, zorder=4, **STAR)
    leader = {"arrowstyle": "-", "linewidth": 0.6, "color": style.BLACK, "shrinkA": 0.0, "shrinkB": 4.0}
    axes.annotate(_power(tolerance), (cost, error), (-46.0, -16.0), ha="right", textcoords="offset points",
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
    colours: dict[Any, str]
    markers: dict[Any, str]

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
        """What all signs mean, finite elements first."""
        names = {value: f"elements of order {value}" if self.key == "order" else _said(value) for value in self.colours}
        found = [_sign("o", colour, names[value]) for value, colour in self.colours.items()]
        if len(self.markers) > 1:
            found += [_sign(marker, style.GREY, f"mass: {_said(mass)}") for mass, marker in self.markers.items()]
        if any(point.settings["enforcement"] == "penalty" for point in finite_elements(points)):
            found.append(_sign("o", style.GREY, "raw penalty", markerfacecolor="white"))
        found.append(Line2D([], [], color=style.GREY, linewidth=0.9, label="front of finite elements"))
        found.append(_sign("|", style.GREY, "up to the claimed error bar", markersize=9.0))
        found.append(_sign("*", STAR["color"], "default for a tolerance", markersize=9.0, **_edge()))
        if known_to(points):
            found.append(Line2D([], [], color=style.BLACK, linewidth=0.7, linestyle=":", label="bar of the reference"))
        present = {point.method for point in points if not point.failure}
        return found + [_sign(look["marker"], look["color"], look["label"]) for n, look in LAWS.items() if n in present]


def _edge() -> Look:
    return {key: value for key, value in STAR.items() if key != "color"}


def _said(name: object) -> str:
    return str(name).replace("_", " ")


def _sign(marker: str, colour: str, name: str, **look: Any) -> Line2D:
    return Line2D([], [], linestyle="", marker=marker, color=colour, label=name, **{"markersize": 4.5, **look})
