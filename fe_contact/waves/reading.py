"""A march with waves as a curve: through fewer rows than steps, between which the contact's chatter averages out.

Points of a mesh that stays begin and end their contact one by one, and a dashpot in parallel differentiates that. The
impulse hardly knows of it: a local cubic through the mean force since touch, as Savitzky and Golay smooth
(doi:10.1021/ac60214a047), keeps what is smooth and knows of chatter even less.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from fe_contact.assembly.forms import Array
from fe_contact.budget.change import Change
from fe_contact.budget.curve import Curve
from fe_contact.settings import Numerics
from fe_contact.steppers.march import March, Strike

ROWS, AT = 60, 3e-3  # along a contact, and the tolerance for which they suffice: polynomials through six of them
ORDER = 5  # of the force between them
TRUSTED = 2  # of that
SAFETY = 1.25  # as of every other change
DEGREE, REACH = 3, 2  # of the polynomial through all steps so many rows to either side


def curve_of(march: March, strike: Strike, numerics: Numerics, share: float = 1.0) -> Curve:
    """Rows lie closer at touch and separation, and as steps do where those differ; or a ``share`` of them."""
    curve = Curve.of(march, strike)
    rows = _rows(len(curve.x) - 1, numerics, share)
    return replace(curve.through(rows), mean_force=_smoothed(curve.x, curve.mean_force, rows))


def reading(march: March, strike: Strike, numerics: Numerics) -> Change:
    """What these rows leave, as half of them tell."""
    fine, half = (curve_of(march, strike, numerics, share) for share in (1.0, 0.5))
    return Change(fine, half, SAFETY / (2**TRUSTED - 1))


def _rows(steps: int, numerics: Numerics, share: float) -> npt.NDArray[np.intp]:
    """Those to keep of the first and so many steps; both ends."""
    count = share * ROWS * (AT / numerics.tolerance) ** (1 / ORDER) * max(steps / numerics.steps, 1.0)
    places = np.linspace(0.0, 1.0, math.ceil(count) + 1)
    return np.unique(np.round(steps * places**2 * (3 - 2 * places)).astype(np.intp))


def _smoothed(places: Array, values: Array, rows: npt.NDArray[np.intp]) -> Array:
    """Values (n,) at rows (m,) by the polynomial through what lies around; as they are where too little does."""
    found = values[rows]
    last = len(rows) - 1
    for number, row in enumerate(rows[1:-1], start=1):
        around = slice(rows[max(number - REACH, 0)], rows[min(number + REACH, last)] + 1)
        x = places[around] - places[row]
        if len(x) > DEGREE + 1:
            found[number] = np.polyfit(x / np.abs(x).max(), values[around], DEGREE)[-1]
    return found
