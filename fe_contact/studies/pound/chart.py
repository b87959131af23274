"""The chart of pounding structures: storeys that meet, the forces of their contacts, and what every storey suffers."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from fe_contact.studies import style
from fe_contact.studies.pound.study import motions_of
from fe_contact.studies.style import Look, prefixed, readable
from lumped.pounding.frames import Gap
from lumped.pounding.simulation import FramesResult
from lumped.pounding.study import NO_CONTACT, PoundStudy

PANEL, BETWEEN = 1.45, 0.62  # heights of a panel and of what is between two, in
WITHOUT: Look = {"color": style.GREY, "linestyle": (0, (3, 1.5)), "linewidth": 0.9}
MARKERS = "osD^vP"


def plot_study(study: PoundStudy, where: Path, beside: Sequence[str] = ()) -> None:
    """Write ``pound.svg`` and ``pound.png`` into the folder ``where``. ``beside``: what else to say."""
    gaps = list(study.case.frames.gaps)
    rows, lines = 3 if gaps else 2, [*_lines(study), *beside]
    height = PANEL * rows + BETWEEN * (rows - 1)
    with style.sheet(where, "pound", study.case.name, lines, height, above=0.38) as sheet:
        grid = sheet.grid(rows, 1, 0.085, 0.975, hspace=BETWEEN / PANEL)
        top = sheet.figure.add_subplot(grid[0])
        _storeys(top, study)
        if gaps:
            _forces(sheet.figure.add_subplot(grid[1], sharex=top), study)
        sides = list(study.case.frames.frames)
        below = grid[rows - 1].subgridspec(1, 2 * len(sides), wspace=0.35)
        places = [sheet.figure.add_subplot(below[i]) for i in range(2 * len(sides))]
        for k, axes in enumerate(places):
            _profile(axes, study, sides[k // 2], "drift" if k % 2 == 0 else "acceleration", "abcdef"[rows - 1 + k])


def looks(study: PoundStudy) -> dict[str, Look]:
    """A colour for every law."""
    found: dict[str, Look] = {
        name: {"color": style.CYCLE[i % len(style.CYCLE)], "linewidth": 1.1} for i, name in enumerate(study.motions)
    }
    return found | {NO_CONTACT: WITHOUT}


def _lines(study: PoundStudy) -> list[str]:
    """Measures under every law, in words."""
    lines = []
    for name, result in motions_of(study).items():
        m = result.measures()
        said = f"{name}: peak drift {readable(m['peak_drift'], 'm', 3)}, acceleration {m['peak_acceleration']:.3g} m/s²"
        if name != NO_CONTACT:
            said += f", {m['contacts']} contacts, peak force {readable(m['peak_force'], 'N', 3)}"
        lines.append(said)
    return lines


def _storeys(axes: Axes, study: PoundStudy) -> None:
    """The two storeys of the gap that is struck hardest; the right one as far away as the gap is wide."""
    result, frames = study.main, study.case.frames
    metre, unit = prefixed(float(np.abs(result.motion.displacement).max()) or 1.0, "m")
    hardest = max(result.contacts, key=lambda contact: contact.peak_force, default=None)
    name = hardest.gap if hardest else next(iter(frames.gaps), None)
    gap = frames.gaps[name] if name else Gap(frames.left.size)
    time = result.motion.time
    axes.plot(time, metre * result.motion.displacement[:, gap.left - 1], color=style.BLUE, label=f"left {gap.left}")
    if gap.right is not None:
        right = result.motion.displacement[:, frames.left.size + gap.right - 1] + gap.distance
        axes.plot(time, metre * right, color=style.ORANGE, label=f"right {gap.right}, a gap away")
    elif name:
        axes.axhline(metre * gap.distance, color=style.ORANGE, linewidth=0.8, label="wall")
    axes.set(ylabel=f"place, {unit}", xlim=(0.0, time[-1]))
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, borderaxespad=0.1, columnspacing=1.2)
    under = next(iter(study.motions), "")
    style.label(axes, "a", f"storeys at gap {name}, {under}" if name else "top of the left structure")


def _forces(axes: Axes, study: PoundStudy) -> None:
    """A stem for every contact, as high as its largest force."""
    newton, unit = prefixed(max(motion.result.peak_force for motion in study.motions.values()) or 1.0, "N")
    for i, (name, motion) in enumerate(study.motions.items()):
        contacts = motion.result.contacts
        time = np.array([contact.peak_time for contact in contacts])
        force = newton * np.array([contact.peak_force for contact in contacts])
        look = looks(study)[name]
        axes.vlines(time, 0.0, force, color=look["color"], linewidth=0.7, alpha=0.5)
        axes.plot(time, force, MARKERS[i % len(MARKERS)], color=look["color"], markersize=2.6, label=name)
    axes.set(ylabel=f"peak force, {unit}", xlabel="time, s", ylim=(0.0, None))
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=6, borderaxespad=0.1, columnspacing=1.2)
    style.label(axes, "b", "contacts")


def _profile(axes: Axes, study: PoundStudy, side: str, what: str, letter: str) -> None:
    """The peaks of every storey of one structure."""
    size = study.case.frames.frames[side].size
    largest = max(max(_peaks(result, side, what)) for result in motions_of(study).values())
    factor, unit = prefixed(largest, "m") if what == "drift" else (1.0, "m/s²")
    for name, result in motions_of(study).items():
        values = factor * np.array(_peaks(result, side, what))
        axes.plot(values, np.arange(1, size + 1), marker="o", markersize=2.2, label=name, **looks(study)[name])
    axes.set(xlabel=f"{what}, {unit}", xlim=(0.0, None), ylim=(0.5, size + 0.5))
    axes.yaxis.set_major_locator(MaxNLocator(integer=True, nbins=6, min_n_ticks=1))
    if letter in "bc" and what == "drift":
        axes.set_ylabel("storey")
    style.label(axes, letter, f"{side} structure")
    if letter in "bc" and NO_CONTACT in motions_of(study):
        axes.text(0.02, 0.02, f"- - {NO_CONTACT}", transform=axes.transAxes, fontsize=6.2, color="#4d4d4d")


def _peaks(result: FramesResult, side: str, what: str) -> list[float]:
    pairs = zip(result.frames.storeys, result.peaks, strict=True)
    return [float(getattr(peaks, what)) for name, peaks in pairs if name.startswith(f"{side}_")]
