"""The chart of a pounding tuned mass damper: the structure with and without it, its stroke in the ring, the force.

Of the paper's case the first two panels are its Fig. 14.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from fe_contact.studies import style
from fe_contact.studies.style import Look, prefixed, readable
from lumped.ptmd.study import BARE, FULL, PLAIN, PtmdStudy

PANEL = 1.35  # height of a panel, in
LINES: dict[str, Look] = {
    BARE: {"color": style.GREY, "linewidth": 0.8},
    PLAIN: {"color": style.ORANGE, "linewidth": 0.9, "linestyle": (0, (4, 1.6))},
    FULL: {"color": style.BLUE, "linewidth": 1.1},
}


def plot_study(study: PtmdStudy, where: Path) -> None:
    """Write ``ptmd.svg`` and ``ptmd.png`` into the folder ``where``."""
    drawings = [_acceleration, _displacement]
    if study.case.system.damper is not None:
        drawings.append(_stroke)
    if study.case.system.ring is not None:
        drawings.append(_force)
    lines = _lines(study)
    title = f"{study.case.name}: {next(iter(study.results))}"
    height = PANEL * len(drawings) + 0.5 * (len(drawings) - 1)
    with style.sheet(where, "ptmd", title, lines, height, above=0.38) as sheet:
        panels = sheet.figure.subplots(len(drawings), 1, sharex=True, squeeze=False)[:, 0]
        sheet.figure.subplots_adjust(0.085, sheet.bottom, 0.975, sheet.top, hspace=0.5 / PANEL)
        for draw, axes, letter in zip(drawings, panels, "abcd", strict=False):
            draw(axes, study, letter)
        panels[-1].set(xlabel="time, s", xlim=(0.0, study.main.motion.time[-1]))


def _lines(study: PtmdStudy) -> list[str]:
    """Measures of every variant, in words."""
    lines = []
    for name, result in study.results.items():
        m = result.measures
        halved = "" if m.t50 is None else f", last above half of its start at {readable(m.t50, 's', 3)}"
        rms = readable(m.rms_displacement, "m", 4)
        lines.append(f"{name}: root mean square of x1 over {readable(m.window, 's', 3)} {rms}{halved}")
    m = study.main.measures
    if m.contacts:
        depth = readable(m.peak_depth, "m", 3)
        lines.append(f"{m.contacts} contacts, peak force {readable(m.peak_force, 'N', 3)}, penetration {depth}")
    return lines


def _acceleration(axes: Axes, study: PtmdStudy, letter: str) -> None:
    _structure(axes, study, "a1", "m/s2")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, borderaxespad=0.1, columnspacing=1.2)
    style.label(axes, letter, "acceleration of the structure")


def _displacement(axes: Axes, study: PtmdStudy, letter: str) -> None:
    _structure(axes, study, "x1", "m")
    style.label(axes, letter, "displacement of the structure")


def _structure(axes: Axes, study: PtmdStudy, column: str, unit: str) -> None:
    """A column of every variant."""
    motions = {name: study.results[name].motion for name in (BARE, PLAIN, FULL) if name in study.results}
    factor, shown = prefixed(max(float(np.abs(getattr(one, column)).max()) for one in motions.values()), unit)
    for name, motion in motions.items():
        axes.plot(motion.time, factor * getattr(motion, column), label=name, **LINES[name])
    axes.set(ylabel=f"{column}, {shown}")


def _stroke(axes: Axes, study: PtmdStudy, letter: str) -> None:
    """x2 - x1 with the band in which the damper is clear of the undeformed ring."""
    motion, ring = study.main.motion, study.case.system.ring
    stroke = motion.x2 - motion.x1
    metre, unit = prefixed(float(np.abs(stroke).max()), "m")
    if ring is not None:
        axes.axhspan(-metre * ring.gap, metre * ring.gap, color=style.SKY, alpha=0.3, linewidth=0.0)
        axes.text(0.995, metre * ring.gap, "gap ", transform=axes.get_yaxis_transform(), fontsize=6.2,
                  ha="right", va="bottom", color="#4d4d4d")  # fmt: skip
    axes.plot(motion.time, metre * stroke, color=style.GREEN, linewidth=0.9)
    axes.set(ylabel=f"x2 − x1, {unit}")
    style.label(axes, letter, "stroke of the damper")


def _force(axes: Axes, study: PtmdStudy, letter: str) -> None:
    motion = study.main.motion
    newton, unit = prefixed(max(float(np.abs(motion.force).max()), 1e-12), "N")
    axes.plot(motion.time, newton * motion.force, color=style.VERMILION, linewidth=0.9)
    axes.set(ylabel=f"force, {unit}")
    style.label(axes, letter, "pounding force, with the sign of the stroke")
