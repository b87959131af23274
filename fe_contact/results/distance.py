"""How far two forces are apart that are straight between knots, and may jump between two knots of one time."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fe_contact.assembly.forms import Array

GAUSS = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3.0)  # shares of an interval: exact for the square of a line


def distance(force: Callable[[Array], Array], other: Callable[[Array], Array], knots: Array) -> float:
    """Norm over time of the difference over that of ``force``; ``knots`` (k,) of both, s, ascending."""
    lengths = np.diff(knots)[:, None]
    places = knots[:-1, None] + lengths * GAUSS
    known = force(places)
    return float(np.sqrt(np.sum(lengths * (other(places) - known) ** 2) / np.sum(lengths * known**2)))
