"""Forces before and behind a wave front: rows in pairs of one time, where a march has the mean of both in one step."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fe_contact.assembly.forms import Array

Steps = npt.NDArray[np.intp]
TELLING = 3  # steps on either side of a front that tell the force there
TIME, DEPTH, VELOCITY, FORCE, DENT = range(5)  # rows of a reading


def with_fronts(rows: Array, fronts: Steps, spoiled: int) -> Array:
    """Rows (5, n), the last one no longer pressed, with both forces at the ``fronts``, steps of their arrival.

    A surface with mass of its own follows a front after ``spoiled`` steps, in which the force carries that mass along:
    they are left out, and the forces at the front are read off the steps before and behind.
    """
    parts, begin = list[Array](), 0
    for front in fronts.tolist():
        first = front + spoiled + 1
        clean = rows[FORCE, first : min(first + TELLING, rows.shape[1] - 1)]
        before, behind = rows[:, [front]].copy(), rows[:, [front]].copy()
        if front - begin >= TELLING:
            before[FORCE] = _reached(rows[FORCE, front - TELLING : front][::-1], 1)
        if front:
            parts += [rows[:, begin:front], before]
        if clean.size:
            behind[FORCE] = _reached(clean, spoiled + 1)
            parts.append(behind)
        begin = first if clean.size else front + (front > 0)
    return np.hstack([*parts, rows[:, begin:]])


def _reached(forces: Array, away: int) -> float:
    """The force ``away`` steps before the first of some, N, by the polynomial through them; none pulls."""
    steps = away + np.arange(forces.size)
    return max(float(np.polyfit(steps, forces, forces.size - 1)[-1]), 0.0)
