"""The charts of the rings, finite elements against the paper's row: force and exponent over depth; struck, Fig. 12."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from fe_contact.studies import style
from fe_contact.studies.rings import SMALL_STRAIN, RingCurve, RingStruck
from fe_contact.studies.style import Look
from lumped.fit import fit
from lumped.paper.ring_impacts import force
from lumped.scene.scene import Scene
from lumped.scene.tables import LawChoice

PANEL = 2.7  # height, in
LINES = [
    "Finite elements, bars within the lines' width where none is seen. Left: F over (pi/4) E* l depth, 1 (dotted) "
    "where (27)-(32) hold; right: d ln F/d ln depth, by the row 1. Shaded: strains beyond "
    f"{100 * SMALL_STRAIN:g} %, where linear theory only indicates.",
]


POINTS = 201  # of a curve
STRUCK_LINES = [
    "The reduced mass of the damper's two bodies strikes the paper's ring at the speed that by (30)-(32) strains it by "
    f"{100 * SMALL_STRAIN:g} %; thickness and speed are not printed, nor does the text hold the measured curve. "
    "Jankowski's law is fitted to the finite elements by least error, (20), its k and xi free.",
]


def plot_rings(curves: Sequence[RingCurve], where: Path, impacts: Sequence[RingStruck]) -> None:
    """Write ``ring`` and, of impacts, ``fig12``, as SVG and PNG, into the folder ``where``.

    ``fig12.csv`` holds the curves that it draws. Raises NotReached.
    """
    _pressed(curves, where)
    _fig12(impacts, where)


def _fig12(impacts: Sequence[RingStruck], where: Path) -> None:
    fastest = {one.ring: one for one in sorted(impacts, key=lambda one: one.velocity)}
    title = "Fig. 12 drawn again on the ring"
    with style.sheet(where, "fig12", title, STRUCK_LINES, PANEL) as sheet:
        panels = sheet.panels(1, len(fastest), 0.075, 0.985, wspace=0.22)
        for axes, letter, one in zip(panels, "ab", fastest.values(), strict=False):
            _struck(axes, one)
            style.label(axes, letter, f"{one.ring} at {style.readable(one.velocity, 'm/s', 3)}")
    style.write_curves(sheet.figure, where, "fig12")


def _struck(axes: Axes, one: RingStruck) -> None:
    found = one.found.history
    newton, unit = style.prefixed(float(found.force.max()), "N")
    second, seconds = style.prefixed(float(found.time[-1]), "s")
    times = np.linspace(0.0, one.row.duration, POINTS)
    fitted = fit(found, "jankowski", Scene(None, one.mass, one.velocity, law=LawChoice("jankowski", {})))
    drawn: tuple[tuple[str, np.ndarray, np.ndarray, Look], ...] = (
        ("finite elements", found.time, found.force, {"color": style.GREY, "linewidth": 3.2, "alpha": 0.6}),
        ("(30)-(32)", times, one.velocity * force(one.spring, one.mass, times), {"color": style.VERMILION}),
        (f"Jankowski, {100 * fitted.normalized_error:.2g} %", fitted.history.time, fitted.history.force,
         {"color": style.GREEN, "linewidth": 0.9}),
    )  # fmt: skip
    for name, time, curve, look in drawn:
        axes.plot(second * time, newton * curve, label=name, **look)
    axes.set(xlabel=f"time, {seconds}", ylabel=f"force, {unit}", xlim=(0.0, None), ylim=(0.0, None))
    axes.legend(loc="upper right", fontsize=5.6, labelspacing=0.2)


def _pressed(curves: Sequence[RingCurve], where: Path) -> None:
    title = "Rings pressed slowly against the paper's row"
    with style.sheet(where, "ring", title, LINES, PANEL) as sheet:
        left, right = sheet.panels(1, 2, 0.075, 0.985, wspace=0.22)
        for colour, curve in zip((*style.CYCLE, style.BLACK), curves, strict=False):
            look: Look = {"color": colour, "marker": "o", "markersize": 2.4, "linewidth": 1.0}
            left.errorbar(curve.strain, curve.factor, yerr=curve.factor_error, label=curve.case.name, **look)
            right.errorbar(curve.strain, curve.exponent, yerr=curve.exponent_error, **look)
        left.set(yscale="log", ylabel="F over the row's")
        style.plain_numbers(left.yaxis)
        right.set(ylabel="d ln F/d ln depth")
        for axes, letter, title in ((left, "a", "force over (27)"), (right, "b", "local exponent")):
            _finished(axes)
            style.label(axes, letter, title)
        left.legend(loc="upper left", fontsize=5.6, labelspacing=0.2)


def _finished(axes: Axes) -> None:
    """The row's line and the strains beyond small ones."""
    axes.set(xscale="log", xlabel="depth over what is pressed")
    axes.axhline(1.0, color=style.BLACK, linewidth=0.7, linestyle=":")
    axes.axvspan(SMALL_STRAIN, axes.get_xlim()[1], color=style.GREY, alpha=0.15, linewidth=0)
