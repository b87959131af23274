"""The chart of all laws fitted to one curve: a small panel a law, the best first, with what it leaves."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from fe_contact.studies import style
from fe_contact.studies.style import prefixed
from lumped.fit.ranking import RankedFit
from lumped.result.score import Curve

COLUMNS, HEIGHT = 4, 1.35  # panels beside each other; in, of one of them with what is below it
TITLE_WIDTH = 128  # characters
SCALES = (100, 50, 20, 10, 5, 2, 1, 0.5)  # look: what is left is drawn so many times as large
ROOM = 0.5  # of the peak, for what is left, to either side


def plot_ranking(ranked: Sequence[RankedFit], curve: Curve, where: Path) -> tuple[Path, Path]:
    """Write ``fits.svg`` and ``fits.png`` into the folder ``where``; their paths."""
    shown = [one for one in ranked if one.fit is not None]
    rows = -(-len(shown) // COLUMNS)
    left_out = ", ".join(one.law for one in ranked if one.fit is None)
    lines = ["grey: the curve; red: the law; blue: what is left, enlarged as told. AICc over that of the best law"]
    lines += [f"without a fit: {left_out}"] if left_out else []
    size = rows * HEIGHT
    with style.sheet(where, "fits", "every law, fitted", lines, size, width=TITLE_WIDTH, above=0.34) as sheet:
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
    return sheet.paths


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
