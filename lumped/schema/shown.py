"""How things show themselves in a notebook: a table in HTML, and curves in SVG; no library is needed for either."""

from __future__ import annotations

import html
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lumped.numbers import Array

WIDTH, HEIGHT, LEFT, RIGHT, BELOW, ABOVE = 480, 230, 62, 26, 38, 22  # look: of a picture and its margins, pixels
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")  # Okabe and Ito's, for every eye
MOST_POINTS = 400  # look: of a curve as it is drawn
TICKS = 5  # look: about so many on an axis
Place = Callable[[float, float], tuple[float, float]]


@dataclass(frozen=True)
class Picture:
    """A picture in SVG, which a notebook shows."""

    svg: str

    def __repr__(self) -> str:
        return f'Picture of {WIDTH:g} x {HEIGHT:g}; .write("name.svg") keeps it, a notebook shows it'

    def _repr_svg_(self) -> str:
        return self.svg

    def write(self, path: str | Path) -> Path:
        """Write it into a file that ends with .svg; the file."""
        file = Path(path)
        file.write_text(self.svg, encoding="utf-8")
        return file


def html_table(header: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    """A table with a line of names above it."""
    lines = ["".join(f"<th>{html.escape(name)}</th>" for name in header)]
    lines += ["".join(f"<td>{html.escape(str(cell))}</td>" for cell in row) for row in rows]
    return f"<table>{''.join(f'<tr>{line}</tr>' for line in lines)}</table>"


def curves(lines: Mapping[str, tuple[Array, Array]], x_label: str, y_label: str) -> Picture:
    """Curves by their names, x and y each (n,), on common axes that hold zero."""
    x_ticks, y_ticks = (_reach([line[axis] for line in lines.values()]) for axis in (0, 1))
    across, up = WIDTH - LEFT - RIGHT, HEIGHT - BELOW - ABOVE

    def place(x: float, y: float) -> tuple[float, float]:
        """In pixels."""
        right = (x - x_ticks[0]) / (x_ticks[-1] - x_ticks[0])
        return LEFT + across * right, ABOVE + up * (1.0 - (y - y_ticks[0]) / (y_ticks[-1] - y_ticks[0]))

    parts = [*_axes(x_ticks, y_ticks, place), _text(LEFT + across / 2, HEIGHT - 6, x_label, "middle")]
    parts.append(_text(4, 13, y_label, "start"))
    for number, (name, (x, y)) in enumerate(lines.items()):
        colour, rows = COLOURS[number % len(COLOURS)], np.linspace(0, len(x) - 1, min(len(x), MOST_POINTS)).astype(int)
        points = " ".join(f"{px:.1f},{py:.1f}" for px, py in (place(float(x[i]), float(y[i])) for i in rows))
        parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.6"/>')
        parts.append(_text(WIDTH - RIGHT, ABOVE + 14 * number, name, "end", colour))
    style = 'font-family="sans-serif" font-size="11" style="background:#fff"'
    box = f'xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}"'
    return Picture(f"<svg {box} {style}>{''.join(parts)}</svg>")


def _reach(columns: list[Array]) -> list[float]:
    """Ticks of an axis that holds zero and all columns."""
    return ticks(min(0.0, *(float(one.min()) for one in columns)), max(float(one.max()) for one in columns))


def _axes(x_ticks: list[float], y_ticks: list[float], place: Place) -> Iterator[str]:
    """Lines with their numbers."""
    for y in y_ticks:
        left, height = place(x_ticks[0], y)
        right, _ = place(x_ticks[-1], y)
        yield f'<path d="M{left:.1f} {height:.1f}H{right:.1f}" stroke="#ddd"/>'
        yield _text(left - 5, height + 4, f"{y:.6g}", "end")
    for x in x_ticks:
        across, bottom = place(x, y_ticks[0])
        yield f'<path d="M{across:.1f} {bottom:.1f}v4" stroke="#888"/>'
        yield _text(across, bottom + 16, f"{x:.6g}", "middle")


def _text(x: float, y: float, said: str, anchor: str, colour: str = "#333") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}">{html.escape(said)}</text>'


def ticks(low: float, high: float) -> list[float]:
    """Round numbers in equal steps of 1, 2 or 5 times a power of ten that reach from below `low` to above `high`."""
    span = high - low if high > low else abs(high) or 1.0
    raw = span / TICKS
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= raw * (1.0 - 1e-9))
    first, last = math.floor(low / step + 1e-9), max(math.ceil(high / step - 1e-9), math.floor(low / step + 1e-9) + 1)
    return [step * place for place in range(first, last + 1)]
