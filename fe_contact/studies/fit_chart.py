"""The charts of ``fit``: one law's fit, and all laws fitted to one curve.

Of one law the curve and the fitted force, and what is left between them; of all a small panel a law, the best first,
with what it leaves.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from fe_contact.studies import style
from fe_contact.studies.style import prefixed
from lumped.fit import Estimate, Fit
from lumped.fit.ranking import RankedFit
from lumped.fit.record import LEVEL
from lumped.result.score import Curve

PANELS = 3.1  # height of the two panels with what is between them, in
TITLE_WIDTH = 74  # characters: over one fit
MOST_DIGITS = 7  # look: significant digits of a value, at most
MOST_POINTS = 400  # a denser curve is drawn as a line
COLUMNS, HEIGHT = 4, 1.35  # of all laws: panels beside each other; in, of one of them with what is below it
SCALES = (100, 50, 20, 10, 5, 2, 1, 0.5)  # look: what is left is drawn so many times as large
ROOM = 0.5  # of the peak, for what is left, to either side


def plot_fit(curve: Curve, found: Fit, where: Path) -> None:
    """Write ``fit.svg`` and ``fit.png`` into the folder ``where``."""
    lines = [f"{name} = {_shown(estimate)}" for name, estimate in found.parameters.items()]
    held = ", peak held" if found.peak_held else ""
    lines.append(f"normalized error {found.error_in_words}{held}; intervals of {100.0 * LEVEL:g} %")
    title = f"{found.law}, fitted"
    with style.sheet(where, "fit", title, lines, PANELS, width=TITLE_WIDTH, above=0.34, size=style.COLUMN) as sheet:
        force, left = sheet.figure.subplots(2, 1, sharex=True, height_ratios=(2.2, 1.0))
        sheet.figure.subplots_adjust(0.15, sheet.bottom, 0.965, sheet.top, hspace=0.38)
        _force(force, curve, found)
        _left(left, curve, found)


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
    """The curve less the law, in shares of the peak."""
    span = max(float(curve.time[-1]), float(found.history.time[-1]))
    second, unit = prefixed(float(curve.time[-1]), "s")
    rest = 100.0 * (curve.force - found.history.force_at(curve.time)) / curve.force.max()
    axes.axhline(0.0, color="#4d4d4d", linewidth=0.5)
    axes.plot(second * curve.time, rest, color=style.law_colour(found.law), linewidth=0.8)
    largest = float(np.abs(rest).max()) or 1.0
    axes.set(xlabel=f"time, {unit}", ylabel="curve − law, %", ylim=(-1.15 * largest, 1.15 * largest))
    axes.set_xlim(second * min(float(curve.time[0]), 0.0), 1.01 * second * span)
    style.label(axes, "b", "what is left, over the peak")


def plot_ranking(ranked: Sequence[RankedFit], curve: Curve, where: Path) -> None:
    """Write ``fits.svg`` and ``fits.png`` into the folder ``where``."""
    shown = [one for one in ranked if one.fit is not None]
    rows = -(-len(shown) // COLUMNS)
    left_out = ", ".join(one.law for one in ranked if one.fit is None)
    lines = ["grey: curve; orange: law; blue: the curve less the law, enlarged as told. AICc over that of the best law"]
    lines += [f"without a fit: {left_out}"] if left_out else []
    size = rows * HEIGHT
    with style.sheet(where, "fits", "every law, fitted", lines, size, above=0.34) as sheet:
        panels = sheet.panels(rows, COLUMNS, 0.085, 0.985, hspace=0.62, wspace=0.12)
        for i, (axes, one) in enumerate(zip(panels, shown, strict=False)):
            _panel(axes, one, curve)
            axes.tick_params(labelleft=i % COLUMNS == 0, labelbottom=i + COLUMNS >= len(shown))
        for axes in panels[len(shown) :]:
            axes.set_axis_off()
        _, second = prefixed(float(curve.time[-1]), "s")
        _, newton = prefixed(float(curve.force.max()), "N")
        for i, axes in enumerate(panels[: len(shown)]):
            if i + COLUMNS >= len(shown):
                axes.set_xlabel(f"time, {second}")
            if i % COLUMNS == 0:
                axes.set_ylabel(f"force, {newton}")


def _panel(axes: Axes, one: RankedFit, curve: Curve) -> None:
    if one.fit is None:
        return
    second, _ = prefixed(float(curve.time[-1]), "s")
    newton, _ = prefixed(float(curve.force.max()), "N")
    fitted = one.fit.history.force_at(curve.time)
    axes.axhline(0.0, color="#4d4d4d", linewidth=0.4)
    largest, rest = newton * float(curve.force.max()), newton * (curve.force - fitted)
    scale = next((scale for scale in SCALES if scale * np.abs(rest).max() <= ROOM * largest), SCALES[-1])
    axes.plot(second * curve.time, scale * rest, color=style.BLUE, linewidth=0.5)
    axes.text(0.98, 0.96, f"× {scale:g}", transform=axes.transAxes, color=style.BLUE, ha="right", va="top")
    axes.plot(second * curve.time, newton * curve.force, color="#b0b0b0", linewidth=2.0)
    axes.plot(second * curve.time, newton * fitted, color=style.VERMILION, linewidth=0.9)
    axes.set_ylim(-0.6 * largest, 1.15 * largest)
    error = 100.0 * one.fit.normalized_error
    axes.set_title(f"{one.law}: {error:.2g} %, +{one.criterion:.0f}", pad=3.0, fontsize=7.0)
