"""Texts of a chart that lie over each other or beyond its page: what no number tells of it."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

TOUCH = 1.5  # look: pixels by which the boxes of two texts may meet


def crowded(figure: Figure) -> list[str]:
    """Each of them in words."""
    figure.draw_without_rendering()
    page = figure.bbox
    boxes = [(text.get_text(), text.get_window_extent()) for text in shown(figure)]
    beyond = [
        f"{text!r} is beyond the page"
        for text, box in boxes
        if min(box.x0 - page.x0, box.y0 - page.y0, page.x1 - box.x1, page.y1 - box.y1) < -TOUCH
    ]
    pairs = combinations(boxes, 2)
    return beyond + [f"{one!r} lies over {other!r}" for (one, first), (other, second) in pairs if met(first, second)]


def met(one: Bbox, other: Bbox) -> bool:
    across, up = min(one.x1, other.x1) - max(one.x0, other.x0), min(one.y1, other.y1) - max(one.y0, other.y0)
    return bool(across > TOUCH and up > TOUCH)


def shown(figure: Figure) -> Iterator[Text]:
    """Every upright or level text that is seen."""
    hidden = {text for axes in figure.axes for axis in (axes.xaxis, axes.yaxis) for text in unseen(axis)}
    for text in figure.findobj(Text):
        if text not in hidden and text.get_visible() and text.get_text().strip() and text.get_rotation() % 90.0 == 0.0:
            yield text


def unseen(axis: Axis) -> Iterator[Text]:
    """Names of ticks beyond the axis, and all of an axis that is off."""
    low, high = sorted(axis.get_view_interval())
    off, slack = not axis.axes.axison, 1e-9 * (high - low)
    for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks()):
        if off or not low - slack <= tick.get_loc() <= high + slack:
            yield from (tick.label1, tick.label2)
    if off:
        yield from (axis.label, axis.offsetText)
