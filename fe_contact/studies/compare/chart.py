"""The chart of a comparison: forces, their distance from the reference, contact radius and pressure in the rebound."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from fe_contact.fields import felt
from fe_contact.reference import Solved
from fe_contact.studies import style
from fe_contact.studies.compare.deviations import rebound_steps, surface_radii
from fe_contact.studies.compare.law_pressure import LawPressure
from fe_contact.studies.compare.study import MEASURED, Comparison, judged
from fe_contact.studies.history_chart import caption
from fe_contact.studies.style import Look, prefixed, readable
from lumped.numbers import Array
from lumped.result.history import History
from lumped.result.score import Curve as Measured

PANELS = 4.6  # height of the four panels with what is around them, in
LEAST_SHOWN = 1e-6  # of the peak: the lower end of the logarithmic panel
LEGEND, ROW, NAMES = 0.3, 0.17, 6  # in, above the panels; a further row of the legend, in, and names in one
MOST_TIMES = 3.0  # look: of the reference's end, beyond which no law that ends later is shown
MOST_TENSION = 0.6  # of the largest pressure: a viscous law's tension at the edge is singular, and cut there
# A dash a candidate, beside a law's colour: the reference is a broad grey line below all of them.
STYLES: dict[str, Look] = {
    "hertz": {"linestyle": (0, (1, 1.2))},
    "correspondence": {"linestyle": "-"},
    "ting": {"linestyle": (0, (5, 2.2))},
    "mdr": {"linestyle": (2.5, (2.2, 5))},
    MEASURED: {"color": style.BLACK, "linestyle": "none", "marker": ".", "markersize": 2.5, "zorder": 4.0},
}
REFERENCE: Look = {"color": "#b8b8b8", "linewidth": 4.2, "solid_capstyle": "butt"}


def plot_comparison(comparison: Comparison, where: Path) -> tuple[Path, Path]:
    """Write ``compare.svg`` and ``compare.png`` into the folder ``where``; their paths."""
    lines = list(judged(comparison))
    scene = comparison.reference.scene
    further = (len(comparison.judgements) + 1) // NAMES  # rows of the legend, beside the first
    title, above = f"{scene.name} against finite elements", 0.55 + ROW * further
    ratios = {"width_ratios": (1.25, 1.0), "height_ratios": (1.15, 1.0)}
    with style.sheet(where, "compare", title, lines, PANELS, above=above, below=0.65) as sheet:
        grid = sheet.grid(2, 2, 0.082, 0.982, hspace=0.42, wspace=0.26, **ratios)
        for place, draw in (((0, 0), _force), ((1, 0), _distance), ((0, 1), _radius), ((1, 1), _pressure)):
            draw(sheet.figure.add_subplot(grid[place]), comparison)
        _legend(sheet.figure, comparison, sheet.top + LEGEND / sheet.figure.get_figheight())
        style.footnote(sheet.figure, caption(scene))
    return sheet.paths


def _candidates(comparison: Comparison) -> Iterator[tuple[History | Measured, Look]]:
    """Every candidate's curve and its line."""
    for name, law in comparison.laws.items():
        yield law.history, line_of(name)
    if comparison.measured is not None:
        yield comparison.measured, line_of(MEASURED)


def line_of(name: str) -> Look:
    """Colour and dashes of a candidate, the same in every chart."""
    return {"color": style.law_colour(name)} | STYLES.get(name, {"linewidth": 0.8})


def _legend(figure: Figure, comparison: Comparison, height: float) -> None:
    names = [judgement.name for judgement in comparison.judgements]
    handles: list[Artist] = [Line2D([], [], **REFERENCE)]
    handles += [Patch(color=style.SKY, alpha=0.45, linewidth=0)]
    handles += [Line2D([], [], **line_of(name)) for name in names]
    labels = ["finite elements", "their error bar", *("measured curve" if one == MEASURED else one for one in names)]
    columns = min(len(labels), NAMES)
    figure.legend(handles, labels, loc="lower left", bbox_to_anchor=(0.07, height - 0.012), ncols=columns,
                  columnspacing=1.5, handlelength=2.4, borderaxespad=0.0)  # fmt: skip


def _force(axes: Axes, comparison: Comparison) -> None:
    history = comparison.reference.history
    second, span = _time_axis(axes, comparison)
    newton, unit = prefixed(history.force.max(), "N")
    axes.plot(second * history.time, newton * history.force, **REFERENCE)
    for curve, line in _candidates(comparison):
        axes.plot(second * curve.time, newton * curve.force, **line)
    axes.fill_between(
        second * history.time,
        newton * np.maximum(history.force - history.force_error, 0.0),
        newton * (history.force + history.force_error),
        color=style.SKY,
        alpha=0.45,
        linewidth=0.0,
    )
    turn = comparison.told.deepest
    side, shift = ("left", 3.0) if turn < 0.6 * span else ("right", -3.0)
    axes.annotate("maximum depth", (second * turn, 0.0), (shift, 3.0), textcoords="offset points", ha=side,
                  fontsize=6.0, color="#666666")  # fmt: skip
    forces = [(curve.time, curve.force) for curve in (history, *(curve for curve, _ in _candidates(comparison)))]
    axes.set(ylabel=f"force, {unit}", ylim=(0.0, newton * _highest(forces, span)))
    style.label(axes, "a", "contact force")


def _distance(axes: Axes, comparison: Comparison) -> None:
    """|force - reference| over the peak, logarithmic, so that the error bar can be seen."""
    told = comparison.told
    second, span = _time_axis(axes, comparison)
    even = np.linspace(0.0, span, 1200)
    inside = even[even <= told.duration]
    top = np.maximum(told.force_error(inside) / told.peak, LEAST_SHOWN)
    axes.fill_between(second * inside, LEAST_SHOWN, top, color=style.SKY, alpha=0.45, linewidth=0.0)
    for candidate, line in _candidates(comparison):
        own = isinstance(candidate, Measured)  # between its rows nothing is known
        times = candidate.time[(candidate.time >= 0.0) & (candidate.time <= span)] if own else even
        distance = np.abs(candidate.force_at(times) - told.force(times)) / told.peak
        ended = times > max(told.duration, float(candidate.time[-1]))
        axes.plot(second * times, np.where(ended, np.nan, np.maximum(distance, 0.5 * LEAST_SHOWN)), **line)
    axes.set(yscale="log", ylabel="share of the peak", ylim=(LEAST_SHOWN, 2.0))
    style.label(axes, "c", "distance from the reference's force")


def _radius(axes: Axes, comparison: Comparison) -> None:
    history = comparison.reference.history
    second, span = _time_axis(axes, comparison)
    metre, unit = prefixed(history.contact_radius.max(), "m")
    axes.plot(second * history.time, metre * history.contact_radius, **REFERENCE)
    for name, law in comparison.laws.items():
        axes.plot(second * law.history.time, metre * law.history.contact_radius, **line_of(name))
    radii = [(one.time, one.contact_radius) for one in (history, *(law.history for law in comparison.laws.values()))]
    axes.set(ylabel=f"radius, {unit}", ylim=(0.0, metre * _highest(radii, span)))
    style.label(axes, "b", "contact radius")


def _pressure(axes: Axes, comparison: Comparison) -> None:
    """Pressure at the last of the compared instants of the rebound, where a clipped law and the truth part most."""
    solved = comparison.solved
    steps = () if solved is None else rebound_steps(solved)
    if solved is None or not steps:
        axes.set_axis_off()
        axes.text(0.0, 0.9, _without_pressure(solved), transform=axes.transAxes)
        return
    truth = felt(solved.certified, steps[-1])
    radii = surface_radii(solved)
    metre, length_unit = prefixed(radii[-1], "m")
    pascal, unit = prefixed(truth.values.max(), "Pa")
    axes.axhline(0.0, color="#4d4d4d", linewidth=0.5)
    axes.plot(metre * radii, pascal * truth.at(radii), **REFERENCE)
    lowest, most = 0.0, pascal * truth.values.max()
    pressures = {name: LawPressure.of(law) for name, law in comparison.laws.items()}
    for name, pressure in pressures.items():
        if pressure is not None:
            values = pascal * pressure.at(truth.time, radii)
            axes.plot(metre * radii, values, **line_of(name))
            if values.min() < min(lowest, -0.02 * most):
                lowest = max(float(values.min()), -MOST_TENSION * most)
                start = metre * radii[np.argmax(values <= 0.8 * lowest)]
    if lowest < 0.0:
        axes.set_ylim(bottom=1.15 * lowest)
        axes.text(start, lowest, "tension  ", ha="right", style="italic", color=style.BLACK)
    without = " (laws of a force alone tell none)" if None in pressures.values() else ""
    axes.set(xlabel=f"radius, {length_unit}{without}", ylabel=f"pressure, {unit}", xlim=(0.0, metre * radii[-1]))
    style.label(axes, "d", f"pressure in the rebound, at {readable(truth.time, 's', 3)}")


def _without_pressure(solved: Solved | None) -> str:
    """Why there is no pressure to show."""
    if solved is None:
        return "with waves, yield or large strains\nthe history alone is compared"
    told = solved.certified.march.snapshots
    return "no rebound before the end of the history" if told else "under a flat end: that of the indentation"


def _highest(curves: Sequence[tuple[Array, Array]], span: float) -> float:
    """The upper end of an axis that shows curves, times, s, and values, (n,) each, up to a time, s, with some room."""
    times = np.linspace(0.0, span, 1200)
    return 1.05 * max(float(np.interp(times, time, values).max()) for time, values in curves)


def _time_axis(axes: Axes, comparison: Comparison) -> tuple[float, float]:
    """Up to the latest end of any law, but for those that end far later than the reference, which the axis tells; a
    line at the reference's maximum depth; factor of time, that end, s.
    """
    most = MOST_TIMES * float(comparison.reference.history.time[-1])
    latest = max((float(law.history.time[-1]) for law in comparison.laws.values()), default=0.0)
    span = max(min(latest, most), most / MOST_TIMES)
    factor, unit = prefixed(span, "s")
    cut = f" (cut at {MOST_TIMES:g} contact times; laws go on)" if latest > most else ""
    axes.set(xlabel=f"time, {unit}{cut}", xlim=(0.0, 1.01 * factor * span))
    deepest = factor * comparison.told.deepest
    axes.axvline(deepest, color=style.GREY, linewidth=0.6, linestyle=(0, (1, 2)), zorder=0)
    return factor, span
