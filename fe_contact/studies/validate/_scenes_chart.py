"""The chart of the packaged scenes: error over its bar of every quantity that has an exact answer."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from fe_contact.studies import style
from fe_contact.studies.validate._scenes import SceneAnswer

ROW, LEAST = 0.165, 1e-4  # look: height of a scene's row, in; the smallest ratio that is drawn
SIGNS = {
    "peak_force": ("o", style.BLUE),
    "peak_depth": ("s", style.ORANGE),
    "duration": ("^", style.GREEN),
    "impulse": ("v", style.SKY),
    "restitution": ("D", style.VERMILION),
    "peak_time": ("P", style.GREY),
    "history_l2": ("X", style.PURPLE),
}
NAMES = {"history_l2": "history"}
LEGEND = 1.15  # look: room for the names of the signs, in
LABELS = 0.29  # look: room for the names of the scenes, of the width


def plot_scenes(found: Sequence[SceneAnswer], where: Path) -> tuple[Path, Path]:
    """Write ``scenes.svg`` and ``scenes.png`` into the folder ``where``; their paths."""
    held = [one for one in found if one.differences]
    lines = ["Difference from the exact answer over the sum of both error bars; left of the line both can be true."]
    with style.sheet(
        where, "scenes", "Error over its bar", lines, ROW * max(len(held), 3), width=120, above=0.08
    ) as sheet:
        axes = sheet.panels(1, 1, LABELS, 1.0 - LEGEND / style.PAGE)[0]
        axes.axvspan(LEAST, 1.0, color=style.GREEN, alpha=0.07, linewidth=0.0)
        axes.axvline(1.0, color=style.BLACK, linewidth=0.9)
        for name, (marker, colour) in SIGNS.items():
            points = [(move.moved, place) for place, one in enumerate(held) for move in one.differences
                      if move.quantity == name and move.moved is not None]  # fmt: skip
            x, y = [max(moved, LEAST) for moved, _ in points], [place for _, place in points]
            axes.plot(x, y, marker, color=colour, markersize=3.4, label=NAMES.get(name, name.replace("_", " ")))
        axes.set(xscale="log", xlim=(LEAST, 3.0), ylim=(len(held) - 0.4, -0.6), xlabel="error over its bar")
        axes.set_yticks(range(len(held)), [f"{one.scene}  ({one.exact.replace('_', ' ')})" for one in held])
        axes.grid(axis="y", color=style.GREY, linewidth=0.3, alpha=0.4)
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0)
    return sheet.paths
