"""Fig. 15 as numbers: the dent that is left when the ball parts, and what a second impact finds of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fe_contact.studies import style
from fe_contact.studies.style import Look
from lumped.paper.examples.dented_surface import DentedSurface
from lumped.paper.examples.given import Examples

MICRO = 1e6
HEIGHT, TITLE_WIDTH = 3.3, 130  # in, characters
POINTS, PAUSES = 241, 16
# Times in units of R2: how long the surface is shown, and the shortest and longest pause.
SHOWN, SHORTEST, LONGEST = 4.0, 1e-2, 1e1
DASHED: Look = {"linestyle": (0, (3, 1.6)), "linewidth": 0.8}
KEY = (
    Line2D([], [], color=style.GREY, label="surface"),
    Line2D([], [], color=style.GREY, label="ball after parting", **DASHED),
)


def plot_memory(examples: Examples, where: Path) -> tuple[Path, Path]:
    """Write ``fig15`` as SVG and PNG into the folder ``where``; their paths. Raises TooManySteps."""
    dents = dented(examples)
    figure = Figure(figsize=(style.PAGE, HEIGHT))
    left, right = figure.subplots(1, 2)
    figure.subplots_adjust(0.07, 0.14, 0.985, 0.74, wspace=0.2)
    for dent, colour in zip(dents, style.CYCLE, strict=False):
        _recovery(left, dent, colour)
        _second(right, dent, colour)
    R2 = style.readable(dents[0].R2, "s", 3)
    left.set(xlabel="time, µs", ylabel="depth / greatest depth", xlim=(0.0, None), ylim=(0.0, 1.05))
    left.legend(handles=KEY, loc="upper right")
    right.set(xlabel="pause between two impacts / R2", ylabel="peak of the second / first", xscale="log")
    right.legend(loc="upper right")
    style.label(left, "a", "the surface comes back after the ball has gone")
    style.label(right, "b", "an equal impact on what is left of the dent")
    lines = [f"Steel ball, R2 = {R2}: out of contact the load depth^1.5 of the surface falls as exp(-t/R2)."]
    style.heading(figure, "Fig. 15 as numbers: memory between contacts", lines, TITLE_WIDTH)
    return style.save(figure, where, "fig15")


def dented(examples: Examples) -> list[DentedSurface]:
    """The curves of the panel of Fig. 7 whose R2 is nearest to the contact time: there the dent is deepest."""
    steel, grids = examples.steel, examples.grids
    contact = DentedSurface(steel, min(grids.fig7_R1), min(grids.fig7_R2)).parting
    nearest = min(grids.fig7_R2, key=lambda R2: abs(np.log(R2 / contact)))
    return [DentedSurface(steel, R1, nearest) for R1 in grids.fig7_R1]


def _recovery(axes: Axes, dent: DentedSurface, colour: str) -> None:
    times = np.linspace(0.0, dent.parting + SHOWN * dent.R2, POINTS)
    away = np.linspace(dent.parting, times[-1], POINTS)
    deepest, ball = dent.first.peak_depth, dent.ball(away)
    axes.plot(MICRO * times, dent.surface(times) / deepest, color=colour)
    axes.plot(MICRO * away[ball > 0.0], ball[ball > 0.0] / deepest, color=colour, **DASHED)


def _second(axes: Axes, dent: DentedSurface, colour: str) -> None:
    pauses = np.geomspace(SHORTEST, LONGEST, PAUSES)
    peaks = [dent.second(pause * dent.R2).peak_force / dent.first.peak_force for pause in pauses]
    axes.plot(pauses, peaks, color=colour, label=f"R1 = {dent.R1:g}")
