"""What the steps of a bouncing bar say: one history of all its contacts, and each contact by itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.dynamics.march import Motion, Sample
from fe_contact.waves.fronts import DEPTH, FORCE, TIME, VELOCITY, with_fronts
from fe_contact.waves.rod_reading import Contacts, RodReading, stopped
from lumped.scene.scene import Scene

SPOILED, TELLING = 8, 8  # steps at the ends of a contact in which its element rings, and those beside them
UNENDED = {"duration": None, "restitution": None}
DROPPED = 0.6  # of what was to be expected, below which a force drops


@dataclass
class Ending:
    """Told sample after sample, says when the last of some contacts is over: open for longer than a ``pause``, s."""

    impacts: int
    pause: float
    begun: int = 0
    last: float = -np.inf
    open: bool = True

    def __call__(self, sample: Sample) -> bool:
        away = sample.time - self.last
        if sample.force > 0.0:
            self.begun += self.open and away > self.pause
            self.last = sample.time
        self.open = sample.force <= 0.0
        return self.open and self.begun == self.impacts and away > self.pause


def read(found: Motion, total: float, scene: Scene, pause: float, echo: int | None) -> tuple[RodReading, Contacts]:
    """Rows up to the last separation and every contact; ``total`` mass, kg; those within a ``pause``, s, are one.

    ``echo``: steps after which a front comes back, None where steps do not follow it.
    Impulse and history are those of all contacts, the other quantities those of the first.
    """
    rows = np.array([_row(sample) for sample in found.samples]).T
    spans = clustered(found.seen, pause)
    if scene.motion.impacts > 1:
        rows = _cleaned(rows, spans)
    elif echo:
        rows = with_fronts(rows, np.arange(echo, rows.shape[1] - 2, echo), spoiled=0)
    separated = len(spans) == scene.motion.impacts and rows[FORCE, -1] <= 0.0
    if separated:
        rows, end = _ended(rows, spans[-1][1])
        spans[-1] = (spans[-1][0], end)
    else:
        rows = stopped(rows, scene.end_time)
    impulses = np.cumsum([sample.impulse for sample in found.samples])
    contacts = tuple(_contact(rows, found.time, impulses, span, total, scene.gravity) for span in spans)
    if found.force[-1] > 0.0:  # it goes on
        contacts = (*contacts[:-1], {**contacts[-1], **UNENDED})
    first = contacts[0]  # of the later ones a front that comes a little early or late makes another peak
    quantities = {
        "peak_force": first["peak_force"],
        "peak_time": first["peak_time"],
        "peak_depth": first["peak_depth"],
        "duration": first["duration"],
        "restitution": first["restitution"],
        "impulse": float(np.interp(rows[TIME, -1], found.time, impulses)),
        "history_l2": 0.0,
    }
    return RodReading(rows, total, separated, quantities), contacts


def clustered(contacts: tuple[tuple[float, float], ...], pause: float) -> list[tuple[float, float]]:
    """Contacts that follow each other within a pause, s, as one."""
    found = list[tuple[float, float]]()
    for start, end in contacts:
        if found and start - found[-1][1] < pause:
            found[-1] = (found[-1][0], end)
        else:
            found.append((start, end))
    return found


def _row(sample: Sample) -> tuple[float, ...]:
    """A bar has no dent: in its place stands the gap to the plane, below zero."""
    return sample.time, float(sample.displacement[0]), float(sample.velocity[0]), sample.force, float(sample.overlap[0])


def _ended(rows: Array, end: float) -> tuple[Array, float]:
    """Rows up to the separation, s, and when that is; a force that drops there does so between two rows of one time.

    A front that ends the contact leaves the mean of before and behind in its own step: there the contact ends.
    """
    pressed = rows[:, : 1 + int(np.flatnonzero(rows[FORCE] > 0.0)[-1])]
    before = pressed[FORCE, -4:-1]
    dropped = bool(before.size == 3 and pressed[FORCE, -1] < DROPPED * _onwards(before))
    if dropped:
        end, pressed = float(pressed[TIME, -1]), pressed[:, :-1]
    pressed = pressed[:, pressed[TIME] < end]
    last = np.array([np.interp(end, rows[TIME], row) for row in rows])
    last[TIME] = end
    ends = [last * np.where(np.arange(len(last)) == FORCE, 0.0, 1.0)]
    if dropped or pressed[FORCE, -1] > DROPPED * pressed[FORCE].max():
        last[FORCE] = max(_onwards(pressed[FORCE, -3:]), 0.0)
        ends.insert(0, last)
    return np.hstack([pressed, *(row[:, None] for row in ends)]), end


def _cleaned(rows: Array, spans: list[tuple[float, float]]) -> Array:
    """Forces without the ringing of the first element at both ends of every contact, but a line through what follows.

    There the force jumps: two rows of one time at every end within the rows.
    """
    time, cleaned, ends = rows[TIME], rows.copy(), list[Array]()
    for start, end in spans:
        pressed = np.flatnonzero((time >= start) & (time <= end))
        if pressed.size < 2 * (SPOILED + TELLING):
            continue
        for ordered, edge in ((pressed, start), (pressed[::-1], end)):
            telling, spoiled = ordered[SPOILED : SPOILED + TELLING], ordered[:SPOILED]
            line = np.polyfit(time[telling] - start, rows[FORCE, telling], 1)
            cleaned[FORCE, spoiled] = np.maximum(np.polyval(line, time[spoiled] - start), 0.0)
            if time[0] < edge < spans[-1][1]:
                ends += _jump(rows, edge, max(float(np.polyval(line, edge - start)), 0.0), edge == end)
    places = np.searchsorted(time, [row[TIME] for row in ends])
    return np.insert(cleaned, places, np.array(ends).T, axis=1) if ends else cleaned


def _jump(rows: Array, time: float, force: float, falls: bool) -> list[Array]:
    """Two rows of a time, s, between which the force jumps to nothing or from it."""
    without = np.array([np.interp(time, rows[TIME], row) for row in rows])
    without[[TIME, FORCE]] = time, 0.0
    pressed = without.copy()
    pressed[FORCE] = force
    return [pressed, without] if falls else [without, pressed]


def _onwards(values: Array) -> float:
    """The next of some equidistant values along their last straight line."""
    return float(2 * values[-1] - values[-2])


def _contact(
    rows: Array, time: Array, impulses: Array, span: tuple[float, float], total: float, gravity: float
) -> dict[str, float | None]:
    """One contact; velocities are those of the centre of mass, by the force's impulse."""
    start, end = span
    before, after = np.interp([start, end], time, impulses)
    came = float(np.interp(start, rows[TIME], rows[VELOCITY]))
    left = came + gravity * (end - start) - (after - before) / total
    inside = (rows[TIME] >= start) & (rows[TIME] <= end)
    inside[np.searchsorted(rows[TIME], start, side="right") - 1] = True
    top = int(np.argmax(np.where(inside, rows[FORCE], -1.0)))
    return {
        "start": start,
        "duration": end - start,
        "velocity": came,
        "restitution": -left / came,
        "peak_force": float(rows[FORCE, top]),
        "peak_time": float(rows[TIME, top]),
        "peak_depth": float(rows[DEPTH, inside].max()),
    }
