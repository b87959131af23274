"""The chart of a fit: the curve and the fitted force, and what is left between them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from fe_contact.studies import style
from fe_contact.studies.style import prefixed
from lumped.fit import Estimate, Fit
from lumped.result.score import Curve

PANELS = 3.1  # height of the two panels with what is between them, in
TITLE_WIDTH = 74  # characters
MOST_DIGITS = 7  # look: significant digits of a value, at most
MOST_POINTS = 400  # a denser curve is drawn as a line


def plot_fit(curve: Curve, found: Fit, where: Path) -> tuple[Path, Path]:
    """Write ``fit.svg`` and ``fit.png`` into the folder ``where``; their paths."""
    lines = [f"{name} = {_shown(estimate)}" for name, estimate in found.parameters.items()]
    lines.append(f"normalized error {100.0 * found.normalized_error:.3g} %{', peak held' if found.peak_held else ''}")
    title = f"{found.law}, fitted"
    with style.sheet(where, "fit", title, lines, PANELS, width=TITLE_WIDTH, above=0.34, size=style.COLUMN) as sheet:
        force, left = sheet.figure.subplots(2, 1, sharex=True, height_ratios=(2.2, 1.0))
        sheet.figure.subplots_adjust(0.15, sheet.bottom, 0.965, sheet.top, hspace=0.38)
        _force(force, curve, found)
        _left(left, curve, found)
    return sheet.paths


def _shown(estimate: Estimate) -> str:
    """A value with half its interval, cut at the interval's second digit."""
    if estimate.low is None and estimate.high is None:
        return f"{estimate.value:.4g} {estimate.unit}, interval unknown".replace(" ,", ",")
    if estimate.low is None or estimate.high is None:
        side, end = ("above", estimate.low) if estimate.high is None else ("below", estimate.high)
        return f"{estimate.value:.4g}, {side} {end:.4g} {estimate.unit}".rstrip()
    half = 0.5 * (estimate.high - estimate.low)
    digits = math.ceil(math.log10(abs(estimate.value) / half)) + 1 if 0.0 < half < abs(estimate.value) else MOST_DIGITS
    return f"{estimate.value:.{min(max(digits, 2), MOST_DIGITS)}g} ± {half:.2g} {estimate.unit}".rstrip()


def _force(axes: Axes, curve: Curve, found: Fit) -> None:
    history = found.history
    second, _ = prefixed(float(curve.time[-1]), "s")
    newton, unit = prefixed(float(curve.force.max()), "N")
    look = (
        {"marker": ".", "markersize": 2.4, "linewidth": 0.0} if curve.time.size <= MOST_POINTS else {"linewidth": 2.6}
    )
    axes.plot(second * curve.time, newton * curve.force, color="#b0b0b0", label="curve", **look)
    axes.plot(second * history.time, newton * history.force, color=style.law_colour(found.law), label=found.law)
    axes.set(ylabel=f"force, {unit}")
    axes.legend(loc="upper right")
    style.label(axes, "a", "contact force")


def _left(axes: Axes, curve: Curve, found: Fit) -> None:
    """Fitted minus measured, in shares of the peak."""
    span = max(float(curve.time[-1]), float(found.history.time[-1]))
    second, unit = prefixed(float(curve.time[-1]), "s")
    rest = 100.0 * (found.history.force_at(curve.time) - curve.force) / curve.force.max()
    axes.axhline(0.0, color="#4d4d4d", linewidth=0.5)
    axes.plot(second * curve.time, rest, color=style.law_colour(found.law), linewidth=0.8)
    largest = float(np.abs(rest).max()) or 1.0
    axes.set(xlabel=f"time, {unit}", ylabel="% of the peak", ylim=(-1.15 * largest, 1.15 * largest))
    axes.set_xlim(second * min(float(curve.time[0]), 0.0), 1.01 * second * span)
    style.label(axes, "b", "fitted minus measured")
