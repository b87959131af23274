"""The chart of a trade-off: error over processor time and over counted work, the front, the planned defaults."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fe_contact.report import style
from fe_contact.report.history import caption
from fe_contact.validation.front import Measure, finite_elements, front, verdict
from fe_contact.validation.tradeoff import Point
from lumped.scene import Scene

PANELS = 3.9  # height of the panels, in
TITLE_WIDTH = 130  # characters
LEAST = 1e-9  # the lower end of the error axis
ORDERS = {1: style.GREY, 2: style.ORANGE, 3: style.GREEN, 4: style.BLUE}
LAWS: dict[str, dict[str, Any]] = {
    "mdr row": {"color": style.PURPLE, "marker": "D", "label": "row of springs, 25 to 400"},
    "mdr": {"color": style.PURPLE, "marker": "s", "label": "mdr, to its bar"},
    "ting": {"color": style.BLACK, "marker": "^", "label": "ting, to its bar"},
    "hertz": {"color": style.VERMILION, "marker": "X", "label": "hertz"},
    "correspondence": {"color": style.VERMILION, "marker": "P", "label": "correspondence"},
}


def plot_tradeoff(scene: Scene, points: Sequence[Point], where: Path) -> tuple[Path, Path]:
    """Write ``tradeoff.svg`` and ``tradeoff.png`` into the folder ``where``; their paths."""
    lines = list(verdict(points))
    with style.look():
        above, below = style.heading_height(lines, TITLE_WIDTH) + 0.3, 1.35
        height = above + PANELS + below
        figure = Figure(figsize=(style.PAGE, height))
        grid = figure.add_gridspec(1, 2, wspace=0.24, width_ratios=(1.3, 1.0))
        grid.update(left=0.082, right=0.985, top=1 - above / height, bottom=below / height)
        left, right = figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[0, 1])
        _every_method(left, points)
        _finite_elements(right, points, lambda point: point.work["operations"])
        right.set(xlabel="counted work, operations", ylabel="error")
        style.label(right, "b", "finite elements: error over counted work")
        figure.legend(handles=_key(points), loc="lower left", bbox_to_anchor=(0.075, 0.24 / height), ncols=4,
                      columnspacing=1.6, handletextpad=0.5, labelspacing=0.55)  # fmt: skip
        style.heading(figure, f"What accuracy costs: {scene.name}", lines, TITLE_WIDTH)
        figure.text(0.011, 0.011, caption(scene).replace("\n", " "), fontsize=6.0, color="#4d4d4d")
        return style.save(figure, where, "tradeoff")


def _every_method(axes: Axes, points: Sequence[Point]) -> None:
    for method, look in LAWS.items():
        own = [point for point in points if point.method == method and not point.failure]
        cost, error = [point.cpu for point in own], [max(point.error, LEAST) for point in own]
        axes.plot(cost, error, linestyle="-", linewidth=0.7, markersize=4.0, markeredgewidth=0.0, **look)
    _finite_elements(axes, points, lambda point: point.cpu)
    axes.set(xlabel="processor time, s", ylabel="error (the largest of peak, duration, restitution, history)")
    style.label(axes, "a", "every method: error over processor time")


def _finite_elements(axes: Axes, points: Sequence[Point], cost: Measure) -> None:
    """Points by order and enforcement, a whisker up to the claimed bar; the front and the defaults."""
    tried = finite_elements(points)
    for point in tried:
        colour, raw = ORDERS[int(point.settings["order"])], point.settings["enforcement"] == "penalty"
        if point.bar is not None and np.isfinite(point.bar):
            axes.vlines(cost(point), point.error, point.bar, color=colour, linewidth=0.7, alpha=0.4, zorder=1)
        axes.plot([cost(point)], [point.error], "o", markersize=3.6, color=colour, markeredgewidth=0.8,
                  markerfacecolor="white" if raw else colour, zorder=3)  # fmt: skip
    best = front(tried, cost, lambda point: point.error)
    axes.step([cost(p) for p in best], [p.error for p in best], where="post", color=style.GREY, linewidth=0.9, zorder=2)
    for point in tried:
        if point.default_for is not None:
            axes.plot([cost(point)], [point.error], "*", markersize=10.0, color="#F0E442", zorder=4,
                      markeredgecolor=style.BLACK, markeredgewidth=0.7)  # fmt: skip
            leader = {"arrowstyle": "-", "linewidth": 0.6, "color": style.BLACK, "shrinkA": 0.0, "shrinkB": 4.0}
            axes.annotate(_power(point.default_for), (cost(point), point.error), (-46.0, -16.0), ha="right",
                          textcoords="offset points", arrowprops=leader, zorder=5)  # fmt: skip
    axes.set(xscale="log", yscale="log")
    axes.grid(which="major", color="#e6e6e6", linewidth=0.5)
    axes.set_axisbelow(True)


def _power(tolerance: float) -> str:
    """A tolerance as a power of ten where it is one."""
    exponent = np.log10(tolerance)
    return f"$10^{{{exponent:.0f}}}$" if abs(exponent - round(exponent)) < 1e-9 else f"{tolerance:g}"


def _key(points: Sequence[Point]) -> list[Line2D]:
    """What the signs mean, finite elements first."""
    tried = finite_elements(points)
    orders = sorted({int(point.settings["order"]) for point in tried})
    key = [_sign("o", ORDERS[order], f"elements of order {order}") for order in orders]
    key.append(_sign("o", style.GREY, "raw penalty", markerfacecolor="white"))
    key.append(Line2D([], [], color=style.GREY, linewidth=0.9, label="front of finite elements"))
    key.append(_sign("|", style.GREY, "up to the claimed error bar", markersize=9.0))
    star = {"markersize": 9.0, "markeredgecolor": style.BLACK, "markeredgewidth": 0.7}
    key.append(_sign("*", "#F0E442", "default for a tolerance", **star))
    present = {point.method for point in points if not point.failure}
    key += [_sign(look["marker"], look["color"], look["label"]) for name, look in LAWS.items() if name in present]
    return key


def _sign(marker: str, colour: str, name: str, **look: Any) -> Line2D:
    return Line2D([], [], linestyle="", marker=marker, color=colour, label=name, **{"markersize": 4.5, **look})
