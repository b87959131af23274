"""The paper's figures again: Fig. 6, 7 and 8 with the exact law beside the clipped, Fig. 9, Fig. 10 and its cut.

Fig. 15 as numbers: the dent that is left when the ball parts, by the law and by finite elements, and what a second
impact finds of it. Fig. 12 is drawn with the rings, Fig. 14 with the pounding damper.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fe_contact.reference import fe
from fe_contact.studies import style
from fe_contact.studies.style import Look
from lumped.paper.claims import GridRow, PaperStudy
from lumped.paper.concrete_impacts import cut_at_measured_peak, proposed
from lumped.paper.given import Examples, Steel
from lumped.paper.steel_impacts import DentedSurface, R1_of_peak, damped_of_peak, elastic_of_peak, hertz, solid
from lumped.paper.value import MICRO
from lumped.result.history import History
from lumped.result.result import Result

POINTS = 401  # of a curve
HEIGHT_6, HEIGHT_GRID, HEIGHT_9, HEIGHT_10, HEIGHT_15 = 3.7, 5.4, 3.5, 3.3, 3.3  # in
THIN: Look = {"linewidth": 0.6, "alpha": 0.75}  # look
BROAD: Look = {"linewidth": 3.2, "alpha": 0.6}  # look
DASHED: Look = {"linestyle": (0, (3, 1.6)), "linewidth": 0.8}  # look
DAMPED = {"kelvin": (style.ORANGE, 0.2), "jankowski": (style.GREEN, 0.55)}  # look: colour, labels over the peak force
ON_CURVE: Look = {
    "fontsize": 4.6, "rotation": -74.0, "ha": "center", "va": "center",
    "bbox": {"facecolor": "white", "edgecolor": "none", "pad": 0.2},
}  # fmt: skip
DOTS: Look = {"linestyle": "none", "marker": "o", "markersize": 2.2}  # look
TIMES, PAUSES = 241, 16  # of the curves of Fig. 15
# Times in units of R2: how long the surface is shown, and the shortest and longest pause.
SHOWN, SHORTEST, LONGEST = 4.0, 1e-2, 1e1
FE_TOLERANCE = 1e-2  # of the impacts whose surface is drawn: less than a line is wide
LAW_KEY = (
    Line2D([], [], color=style.GREY, label="correspondence, cut at zero force"),
    Line2D([], [], color=style.GREY, label="exact (Ting)", **DASHED),
)
MEMORY_KEY = (
    Line2D([], [], color=style.GREY, label="surface, by the law"),
    Line2D([], [], color=style.GREY, label="ball after parting", **DASHED),
    Line2D([], [], color=style.GREY, label="surface, by finite elements", **DOTS),
)


def plot_paper(study: PaperStudy, where: Path) -> None:
    """Write ``fig6`` to ``fig10`` and ``fig15`` as SVG and PNG into ``where``. Raises NotReached.

    A CSV of each holds the curves that it draws.
    """
    with style.look():
        _fig6(study, where)
        _grid(study, 7, where)
        _grid(study, 8, where)
        for draw in (_fig9, _fig10, _fig15):
            draw(study.examples, where)


def _saved(figure: Figure, where: Path, name: str) -> None:
    """The chart, and beside it what it draws."""
    style.save(figure, where, name)
    style.write_curves(figure, where, name)


def _fig6(study: PaperStudy, where: Path) -> None:
    steel = study.examples.steel
    figure = Figure(figsize=(style.PAGE, HEIGHT_6))
    axes = figure.add_axes((0.075, 0.13, 0.6, 0.68))
    for name, result, look in _curves_6(steel):
        _plot(axes, result, label=name, **look)
    for law in DAMPED:
        _damped(axes, steel, law, MICRO, 1.0)
    axes.axhline(steel.measured_peak, color=style.GREY, linewidth=0.6, linestyle=(0, (1, 1.5)))
    axes.set(xlabel="time, µs", ylabel="force, N", xlim=(0.0, None), ylim=(0.0, 1.08 * steel.measured_peak))
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), labelspacing=0.7)
    lines = [
        f"Dotted: the measured peak, {steel.measured_peak:g} N, which damped curves have too. Along them: e, which the "
        "paper does not print."
    ]
    style.heading(figure, "Fig. 6 drawn again: the steel ball", lines)
    _saved(figure, where, "fig6")


def _curves_6(steel: Steel) -> list[tuple[str, Result, Look]]:
    """Name, impact and look of every curve, those of one family named once."""
    R1, peak = R1_of_peak(steel).value, steel.measured_peak
    curves: list[tuple[str, Result, Look]] = [
        (f"proposed, R1 = {steel.R1:g} as printed", solid(steel, steel.R1, steel.R2), {"color": style.VERMILION}),
        ("nonlinear elastic, theoretical", hertz(steel, steel.contact_modulus), {"color": style.PURPLE}),
        ("nonlinear elastic, equal peak", elastic_of_peak(steel, "hertz", peak), {"color": style.SKY, **BROAD}),
        (f"proposed, R1 = {R1:.3f}, equal peak", solid(steel, R1, steel.R2), {"color": style.VERMILION, **DASHED}),
        ("linear spring, equal peak", elastic_of_peak(steel, "linear_spring", peak), {"color": style.GREY}),
    ]
    return curves


def _damped(axes: Axes, steel: Steel, law: str, time: float, force: float) -> None:
    """The curves of a damped law, times and forces of the ball's in other units; along their falling sides their e."""
    colour, share = DAMPED[law]
    level, es = share * steel.measured_peak, steel.restitutions
    axes.plot([], [], color=colour, label=f"{law.capitalize()}, e = {es[0]:g} to {es[-1]:g}", **THIN)
    for e in es:
        history = damped_of_peak(steel, law, e).history
        drawn = history.resampled(np.linspace(0.0, history.time[-1], POINTS))
        axes.plot(time * drawn.time, force * drawn.force, color=colour, label=f"_{law.capitalize()}, e = {e:g}", **THIN)
        falling = history.force.argmax() + np.flatnonzero(np.diff(history.force[history.force.argmax() :]) < 0.0)
        place = np.interp(-level, -history.force[falling], history.time[falling])
        axes.text(time * place, force * level, f"{e:g}", color=colour, **ON_CURVE)


def _grid(study: PaperStudy, number: int, where: Path) -> None:
    rows = [row for row in study.grid if row.figure == number]
    figure = Figure(figsize=(style.PAGE, HEIGHT_GRID))
    panels = figure.subplots(2, 2, sharex=True, sharey=number == 8).ravel()
    figure.subplots_adjust(0.07, 0.125, 0.985, 0.845, hspace=0.26, wspace=0.16)
    held, varied = ("R2", "R1") if number == 7 else ("R1", "R2")
    for i, axes in enumerate(panels):
        own = [row for row in rows if row.panel == i]
        _panel(axes, own, varied)
        style.label(axes, "abcd"[i], f"{held} = {_value(own[0], held)}")
    panels[0].set_xlim(0.0, 1.03 * MICRO * max(row.exact.history.time[-1] for row in rows))
    for axes in panels[2:]:
        axes.set_xlabel("time, µs")
    for axes in panels[::2]:
        axes.set_ylabel("force, N")
    figure.legend(handles=LAW_KEY, loc="lower center", ncols=2)
    lines = ["The law of the paper, and what it approximates in the rebound; until the deepest instant they are one."]
    style.heading(figure, f"Fig. {number} drawn again: the steel ball, {varied} varied", lines)
    _saved(figure, where, f"fig{number}")


def _panel(axes: Axes, rows: Sequence[GridRow], varied: str) -> None:
    for row, colour in zip(rows, style.CYCLE, strict=False):
        name = f"{varied} = {_value(row, varied)}"
        _plot(axes, row.clipped, color=colour, label=name)
        _plot(axes, row.exact, color=colour, label=f"_exact (Ting), {name}", **DASHED)
    axes.set_ylim(0.0, None)
    axes.legend(loc="upper right", borderaxespad=0.1, labelspacing=0.3)


def _plot(axes: Axes, result: Result, **look: Any) -> None:
    history = result.history.resampled(np.linspace(0.0, result.history.time[-1], POINTS))
    axes.plot(MICRO * history.time, history.force, **look)


def _value(row: GridRow, name: str) -> str:
    return f"{row.R1:g}" if name == "R1" else style.readable(row.R2, "s", 3)


def _fig9(examples: Examples, where: Path) -> None:
    """Over peak and contact time of the proposed model the assumed radius drops out."""
    concrete, steel = examples.concrete, examples.steel
    velocity = min(concrete.velocities)
    whole = proposed(concrete, min(concrete.radii), velocity).history
    figure = Figure(figsize=(style.PAGE, HEIGHT_9))
    axes = figure.add_axes((0.075, 0.14, 0.6, 0.63))
    axes.plot(whole.time / whole.time[-1], whole.force / whole.force.max(), color=style.VERMILION, label="proposed")
    for law in DAMPED:
        _damped(axes, steel, law, *_over(steel, whole, concrete.mass * velocity, 1.0))
    _shares(axes)
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), labelspacing=0.7)
    lines = [
        "Over peak and time of the proposed model; damped curves have its peak. Along them: e, which the paper does "
        "not print, nor does its text hold the measured curve."
    ]
    style.heading(figure, f"Fig. 9 drawn again: concrete at {velocity:g} m/s", lines)
    _saved(figure, where, "fig9")


def _over(steel: Steel, whole: History, momentum: float, share: float) -> tuple[float, float]:
    """What makes times and forces of the ball's damped curves those at another momentum, kg m/s, over those of `whole`;
    their peak is this share of its own. A power law of one e has one shape, F/peak over peak t/(m v).
    """
    longer = momentum / (share * whole.force.max()) * steel.measured_peak / (steel.mass * steel.velocity)
    return longer / whole.time[-1], share / steel.measured_peak


def _shares(axes: Axes) -> None:
    axes.set(xlabel="time / contact time", ylabel="force / peak", xlim=(0.0, None), ylim=(0.0, 1.05))


def _fig10(examples: Examples, where: Path) -> None:
    """Forces and times over those of the uncut impact at the higher velocity: the assumed radius drops out."""
    concrete = examples.concrete
    radius, fast = min(concrete.radii), max(concrete.velocities)
    whole, cut = proposed(concrete, radius, fast).history, cut_at_measured_peak(concrete).curve
    share, measured = (1.0 + concrete.jankowski_peak_error, 1.0) / np.array(1.0 + concrete.peak_error)
    figure = Figure(figsize=(style.PAGE, HEIGHT_10))
    left, right = figure.subplots(1, 2, sharex=True, sharey=True, width_ratios=(1.4, 1.0))
    figure.subplots_adjust(0.07, 0.14, 0.985, 0.74, wspace=0.1)
    for axes in (left, right):
        axes.plot(whole.time / whole.time[-1], whole.force / whole.force.max(), color=style.VERMILION, label="proposed")
    right.plot(cut.time / whole.time[-1], cut.force / whole.force.max(), color=style.BLACK, label="cut", **DASHED)
    _damped(left, examples.steel, "jankowski", *_over(examples.steel, whole, concrete.mass * fast, share))
    for axes, letter, title in ((left, "a", "as computed"), (right, "b", "cut until the impulse is the uncut one's")):
        axes.axhline(measured, color=style.GREY, linewidth=0.6, linestyle=(0, (1, 1.5)))
        _shares(axes)
        axes.legend(loc="upper right")
        style.label(axes, letter, title)
    right.set_ylabel("")
    lines = [
        f"Dotted: the measured peak, by the printed errors of {100 * concrete.peak_error:g} and "
        f"{100 * concrete.jankowski_peak_error:g} %. Cut, the striker leaves as fast as uncut."
    ]
    style.heading(figure, f"Fig. 10 drawn again: concrete at {fast:g} m/s", lines)
    _saved(figure, where, "fig10")


def _fig15(examples: Examples, where: Path) -> None:
    """Raises TooManySteps and NotReached."""
    dents = _dented(examples)
    figure = Figure(figsize=(style.PAGE, HEIGHT_15))
    left, right = figure.subplots(1, 2)
    figure.subplots_adjust(0.07, 0.14, 0.985, 0.74, wspace=0.2)
    for dent, colour in zip(dents, style.CYCLE, strict=False):
        _recovery(left, dent, colour)
        _second(right, dent, colour)
    R2 = style.readable(dents[0].R2, "s", 3)
    left.set(xlabel="time, µs", ylabel="depth / greatest depth", xlim=(0.0, None), ylim=(0.0, 1.05))
    left.legend(handles=MEMORY_KEY, loc="upper right")
    right.set(xlabel="pause between two impacts / R2", ylabel="peak of the second / first", xscale="log")
    right.legend(loc="upper right")
    style.label(left, "a", "the surface comes back after the ball has gone")
    style.label(right, "b", "an equal impact on what is left of the dent")
    lines = [
        f"Steel ball, R2 = {R2}. Out of contact the law lets the load depth^1.5 of the surface fall as exp(-t/R2); by "
        "finite elements the depth of its tip falls so, from less."
    ]
    style.heading(figure, "Fig. 15 as numbers: memory between contacts", lines)
    _saved(figure, where, "fig15")


def _dented(examples: Examples) -> list[DentedSurface]:
    """The curves of the panel of Fig. 7 whose R2 is nearest to the contact time: there the dent is deepest."""
    steel, grids = examples.steel, examples.grids
    contact = DentedSurface(steel, min(grids.fig7_R1), min(grids.fig7_R2)).parting
    nearest = min(grids.fig7_R2, key=lambda R2: abs(np.log(R2 / contact)))
    return [DentedSurface(steel, R1, nearest) for R1 in grids.fig7_R1]


def _recovery(axes: Axes, dent: DentedSurface, colour: str) -> None:
    times = np.linspace(0.0, dent.parting + SHOWN * dent.R2, TIMES)
    away = np.linspace(dent.parting, times[-1], TIMES)
    deepest, ball = dent.first.peak_depth, dent.ball(away)
    names = (f"{key.get_label()}, R1 = {dent.R1:g}" for key in MEMORY_KEY)
    axes.plot(MICRO * times, dent.surface(times) / deepest, color=colour, label=next(names))
    axes.plot(MICRO * away[ball > 0.0], ball[ball > 0.0] / deepest, color=colour, label=next(names), **DASHED)
    found = fe(dent.scene, {"tolerance": FE_TOLERANCE})
    assert found.recovery is not None  # of a half-space that remembers
    since, deepest = float(found.history.time[-1]) + found.recovery.time, float(found.history.depth.max())
    shown = since <= times[-1]
    axes.plot(MICRO * since[shown], found.recovery.depth[shown] / deepest, color=colour, label=next(names), **DOTS)


def _second(axes: Axes, dent: DentedSurface, colour: str) -> None:
    pauses = np.geomspace(SHORTEST, LONGEST, PAUSES)
    peaks = [dent.second(pause * dent.R2).peak_force / dent.first.peak_force for pause in pauses]
    axes.plot(pauses, peaks, color=colour, label=f"R1 = {dent.R1:g}")
