"""The signs of a trade-off's chart: colours for schemes or orders, markers for masses, one each for every law."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.lines import Line2D

from fe_contact.studies import style
from fe_contact.studies.tradeoff.front import finite_elements, known_to
from fe_contact.studies.tradeoff.point import Point

COLOURS = (style.BLUE, style.GREEN, style.ORANGE, style.SKY, style.BLACK, style.VERMILION)
MARKERS = ("o", "s", "^", "v")
STAR: dict[str, Any] = {"color": "#F0E442", "markeredgecolor": style.BLACK, "markeredgewidth": 0.7}
LAWS: dict[str, dict[str, Any]] = {
    "mdr row": {"color": style.PURPLE, "marker": "D", "label": "row of springs, 25 to 400"},
    "mdr": {"color": style.PURPLE, "marker": "s", "label": "mdr, to its bar"},
    "ting": {"color": style.BLACK, "marker": "^", "label": "ting, to its bar"},
    "rod_waves": {"color": style.PURPLE, "marker": "s", "label": "rod_waves, to its bar"},
    "hertz": {"color": style.VERMILION, "marker": "X", "label": "hertz"},
    "correspondence": {"color": style.VERMILION, "marker": "P", "label": "correspondence"},
}


@dataclass(frozen=True)
class Signs:
    """``colours`` by the value of the setting ``key``, ``markers`` by mass."""

    key: str
    colours: dict[Any, str]
    markers: dict[Any, str]

    @classmethod
    def of(cls, points: Sequence[Point]) -> Signs:
        """By scheme where several were tried, else by order; the highest or first in the first colour."""
        tried = finite_elements(points)
        found = {key: {point.settings.get(key) for point in tried} for key in ("scheme", "order", "mass")}
        several = len(found["scheme"]) > 1
        key = "scheme" if several else "order"
        colours = dict(zip(sorted(found[key], key=str, reverse=not several), COLOURS, strict=False))
        return cls(key, colours, dict(zip(sorted(found["mass"], key=str), MARKERS, strict=False)))

    def of_point(self, point: Point) -> dict[str, Any]:
        """Marker and colours of a point of finite elements; hollow with a raw penalty."""
        colour = self.colours[point.settings[self.key]]
        raw = point.settings["enforcement"] == "penalty"
        face = "white" if raw else colour
        return {"marker": self.markers[point.settings.get("mass")], "color": colour, "markerfacecolor": face}

    def legend(self, points: Sequence[Point]) -> list[Line2D]:
        """What all signs mean, finite elements first."""
        names = {value: f"elements of order {value}" if self.key == "order" else _said(value) for value in self.colours}
        found = [_sign("o", colour, names[value]) for value, colour in self.colours.items()]
        if len(self.markers) > 1:
            found += [_sign(marker, style.GREY, f"mass: {_said(mass)}") for mass, marker in self.markers.items()]
        if any(point.settings["enforcement"] == "penalty" for point in finite_elements(points)):
            found.append(_sign("o", style.GREY, "raw penalty", markerfacecolor="white"))
        found.append(Line2D([], [], color=style.GREY, linewidth=0.9, label="front of finite elements"))
        found.append(_sign("|", style.GREY, "up to the claimed error bar", markersize=9.0))
        found.append(_sign("*", STAR["color"], "default for a tolerance", markersize=9.0, **_edge()))
        if known_to(points):
            found.append(Line2D([], [], color=style.BLACK, linewidth=0.7, linestyle=":", label="bar of the reference"))
        present = {point.method for point in points if not point.failure}
        return found + [_sign(look["marker"], look["color"], look["label"]) for n, look in LAWS.items() if n in present]


def _edge() -> dict[str, Any]:
    return {key: value for key, value in STAR.items() if key != "color"}


def _said(name: object) -> str:
    return str(name).replace("_", " ")


def _sign(marker: str, colour: str, name: str, **look: Any) -> Line2D:
    return Line2D([], [], linestyle="", marker=marker, color=colour, label=name, **{"markersize": 4.5, **look})
