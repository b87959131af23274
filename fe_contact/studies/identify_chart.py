"""The chart of an identification: every curve with the identified law's force, and what is left beside its noise."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from fe_contact.studies import style
from fe_contact.studies.style import prefixed, readable
from lumped.identify import FittedCurve, Identified, Interval
from lumped.identify.record import LEVEL

PANELS = 3.2  # height of a row of curves with their residuals, in
COLUMNS, MOST = 3, 6  # look: curves beside each other, and in all
BAND = 2.0  # deviations of the noise
ABOVE: style.Look = {"linewidth": 0.0, "zorder": 3.0}  # look: bands before the rows
PREDICTED = {**ABOVE, "color": style.SKY, "alpha": 0.5}
LAW = {**ABOVE, "color": style.VERMILION, "alpha": 0.6}


def plot_identified(found: Identified, where: Path) -> None:
    """Write ``identified.svg`` and ``identified.png`` into the folder ``where``."""
    curves = found.curves[:MOST]
    columns = min(COLUMNS, len(curves))
    rows = -(-len(curves) // columns)
    lines = [f"{name} = {told(one, name in found.unneeded)}" for name, one in found.parameters.items()]
    lines.append(_verdict(found))
    if found.posterior is not None:
        lines.append(f"orange, below: where the law lies, {100.0 * LEVEL:g} %")
    title, size = f"{found.source.removesuffix('.toml')}: identified", style.COLUMN if columns == 1 else style.PAGE
    width = style.CHARACTERS if columns > 1 else style.CHARACTERS // 2
    law = "Ting's law" if found.by_reference is None else "Ting's law, corrected"
    with style.sheet(where, "identified", title, lines, rows * PANELS, width=width, size=size, above=0.34) as sheet:
        left, right = (0.19, 0.965) if columns == 1 else (0.095, 0.985)
        grid = sheet.grid(rows, columns, left, right, hspace=0.42, wspace=0.32)
        for i, curve in enumerate(curves):
            inner = grid[i].subgridspec(2, 1, height_ratios=(2.2, 1.0), hspace=0.12)
            force = sheet.figure.add_subplot(inner[0])
            rest = sheet.figure.add_subplot(inner[1], sharex=force)
            _force(force, curve, law, "abcdef"[i])
            _left(rest, curve)


def _verdict(found: Identified) -> str:
    if not found.whiteness.of_the_law:
        return found.verdict
    error = 100.0 * max(curve.error for curve in found.curves)
    return f"{found.verdict}: {error:.2g} % of the peak is left beside the noise"


def told(one: Interval, unneeded: bool) -> str:
    """A value with its interval, in prefixed units; no value where any other fits as well."""
    if unneeded:
        high = "open" if one.high is None else readable(one.high, one.unit, 3)
        return f"none, {100.0 * one.level:g} % up to {high}"
    low, high = ("open" if end is None else readable(end, one.unit, one.digits) for end in (one.low, one.high))
    return f"{readable(one.value, one.unit, max(one.digits, 4))}, {100.0 * one.level:g} % from {low} to {high}"


def _force(axes: Axes, curve: FittedCurve, law: str, letter: str) -> None:
    second, _ = prefixed(float(np.ptp(curve.time)), "s")
    newton, unit = prefixed(curve.peak, "N")
    since = second * (curve.time - curve.touch)
    axes.plot(since, newton * curve.force, ".", color=style.GREY, markersize=2.2, label="curve")
    if curve.band.size:
        axes.fill_between(since, *newton * curve.predicted, label=f"{100.0 * LEVEL:g} % predicted", **PREDICTED)
    axes.plot(since, newton * curve.fitted, color=style.VERMILION, zorder=4.0, label=law)
    axes.set(ylabel=f"force, {unit}")
    if letter == "a":
        axes.legend(loc="best")
    axes.tick_params(labelbottom=False)
    style.label(axes, letter, Path(curve.name).stem)


def _left(axes: Axes, curve: FittedCurve) -> None:
    """The curve less the law, in shares of the peak, over a band of two deviations of the noise, and the law's own."""
    second, unit = prefixed(float(np.ptp(curve.time)), "s")
    band = 100.0 * BAND * curve.deviation / curve.peak
    axes.axhspan(-band, band, color="#e6e6e6", linewidth=0.0)
    if curve.band.size:
        law = 100.0 * (curve.band - curve.fitted) / curve.peak
        axes.fill_between(second * (curve.time - curve.touch), *law, **LAW)
    left = 100.0 * (curve.force - curve.fitted) / curve.peak
    axes.plot(second * (curve.time - curve.touch), left, color=style.BLUE, linewidth=0.6)
    axes.set(xlabel=f"time since touch, {unit}", ylabel="curve − law, %")
