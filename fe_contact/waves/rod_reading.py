"""What the steps of an impact on a rod say: a history, rows in pairs where a wave front arrives, and its quantities.

A front crosses one element a step: it leaves at touch and is back after twice as many steps as there are elements. A
struck surface with mass of its own needs two steps to follow it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.dynamics.march import Motion, Sample
from fe_contact.waves.fronts import DENT, DEPTH, FORCE, TELLING, TIME, VELOCITY, with_fronts
from lumped.numbers.interpolation import peak
from lumped.scene.scene import Scene

SPOILED = 2  # steps behind a front
LASTING = 0.5  # of the force before a front, which it would still have had


Contacts = tuple[Mapping[str, float | None], ...]


@dataclass(frozen=True, eq=False)
class RodReading:
    """``rows`` (5, n): time, s, never decreasing; depth, m; velocity, m/s, of a ``mass``, kg; force, N; dent, m. Did
    contact end?
    """

    rows: Array
    mass: float
    separated: bool
    quantities: Mapping[str, float | None]

    def force_at(self, time: Array) -> Array:
        """N, linear between the rows."""
        return np.asarray(np.interp(time, self.rows[TIME], self.rows[FORCE]))


def read(found: Motion, scene: Scene, elements: int, separated: bool) -> RodReading:
    """From the samples of a march; ``elements`` of the rod; whether it has ``separated``. Raises ContactLost."""
    jumping = scene.profile.fixed_radius is not None
    rows = np.array([_row(sample) for sample in found.samples]).T
    end = max(found.seen[-1][1], found.samples[-2].time)  # where rounding opens and closes it, the last of all
    if jumping:
        fronts = np.arange(0, rows.shape[1], 2 * elements, dtype=np.intp)
        if separated and _ended_by(rows[FORCE], fronts[-1]):
            rows = rows[:, : fronts[-1] + 1]
            end, rows = rows[TIME, -1], np.hstack([rows, rows[:, -1:]])
        rows = with_fronts(rows, fronts, SPOILED)
    elif separated:
        end = _undented(rows)
    rows = _ended(rows, end, scene.gravity) if separated else stopped(rows, scene.end_time)
    highest = _highest(rows) if jumping else peak(rows[TIME], rows[FORCE])
    time, _, velocity, _, _ = rows[:, -1]
    quantities = {
        "peak_force": highest[1],
        "peak_time": highest[0],
        "peak_depth": peak(rows[TIME], rows[DEPTH])[1],
        "duration": float(time) if separated else None,
        "restitution": float(-velocity / scene.velocity) if separated else None,
        "impulse": float(scene.reduced_mass * (scene.velocity - velocity + scene.gravity * time)),
        "history_l2": 0.0,
    }
    return RodReading(rows, scene.reduced_mass, separated, quantities)


def _row(sample: Sample) -> tuple[float, ...]:
    dent = max(float(sample.overlap[0]), 0.0)
    return sample.time, float(sample.displacement[0]), float(sample.velocity[0]), max(sample.force, 0.0), dent


def _undented(rows: Array) -> float:
    """When the dent of the last pressed rows, smooth, comes to nothing, s; at the latest a step after them."""
    time, dent = rows[TIME, -4:-1], rows[DENT, -4:-1]
    step = time[-1] - time[-2]
    roots = np.roots(np.polyfit((time - time[-1]) / step, dent, 2))
    ahead = [float(root.real) for root in roots if abs(root.imag) < 1e-9 and 0.0 <= root.real <= 1.0]
    return float(time[-1] + step * min(ahead, default=1.0))


def _ended_by(force: Array, front: int) -> bool:
    """Whether a front ended the contact: the last row, open, follows at once, and the force would have gone on."""
    late = force.size - 1 - front
    if front < TELLING or late > SPOILED + 1:
        return False
    onwards = force[front - 1] + 0.5 * (force[front - 1] - force[front - TELLING]) * (late + 1)
    return bool(onwards > LASTING * force[front - 1])


def stopped(rows: Array, end: float) -> Array:
    """Rows up to a time, s, within the last step; those of a march that stopped before as they are."""
    kept = rows[:, rows[TIME] < end]
    if kept.shape[1] == rows.shape[1]:
        return rows
    return np.hstack([kept, np.array([[np.interp(end, rows[TIME], row)] for row in rows])])


def _ended(rows: Array, end: float, gravity: float) -> Array:
    """Rows up to the end of contact, s, where nothing but gravity moves any more; the last one lies beyond it."""
    last = rows[:, -1].copy()
    beyond = last[TIME] - end
    last[DEPTH] -= beyond * (last[VELOCITY] - 0.5 * beyond * gravity)
    last[VELOCITY] -= beyond * gravity
    last[[TIME, FORCE, DENT]] = end, 0.0, 0.0
    kept = rows[:, :-1][:, rows[TIME, :-1] <= end]
    return np.hstack([kept, last[:, None]])


def _highest(rows: Array) -> tuple[float, float]:
    """Time and force of the highest row: where the force jumps no polynomial goes through its rows."""
    top = int(np.argmax(rows[FORCE]))
    return float(rows[TIME, top]), float(rows[FORCE, top])
