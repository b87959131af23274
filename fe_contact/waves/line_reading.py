"""What the steps of an impact say whose waves run along a line: a history, its quantities, and each of its contacts.

On a rod a front crosses one element a step: it leaves at touch and is back after twice as many steps as there are
elements. A struck surface with mass of its own needs two steps to follow it.

Forces before and behind a wave front are rows in pairs of one time, where a march has the mean of both in one step.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from fe_contact.assembly.forms import Array
from fe_contact.budget.budget import Contacts
from fe_contact.dynamics.march import Motion, Sample
from lumped.numbers import peak
from lumped.scene.scene import Scene
from lumped.targets.rod import Rod

TIME, DEPTH, VELOCITY, FORCE, DENT = range(5)  # rows of a reading
Steps = npt.NDArray[np.intp]
TELLING = 3  # steps on either side of a front that tell the force there
SPOILED = 2  # steps behind a front
LASTING = 0.5  # of the force before a front, which it would still have had
RINGING, CLEAR = 8, 8  # steps at the ends of a contact and at fronts in which its element rings, and those beside
DROPPED = 0.6  # of what was to be expected, below which a force drops
UNENDED = {"duration": None, "restitution": None}
ROUNDING = 1e-9  # relative, of what adds up over the steps


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


@dataclass(frozen=True, eq=False)
class RodReading:
    """``rows`` (5, n): time, s, never decreasing; depth, m; velocity, m/s, of a ``mass``, kg; force, N; dent, m. Did
    contact end? How long after its end, s, may what a front left of the force have pressed on? ``blurred``: times, s,
    between which no more is known of the force than a line, ``relaxed``, N, what it missed in the first of them.
    """

    rows: Array
    mass: float
    separated: bool
    quantities: Mapping[str, float | None]
    lingers: float = 0.0
    blurred: tuple[tuple[float, float], ...] = ()
    relaxed: float = 0.0

    def force_at(self, time: Array) -> Array:
        """N, linear between the rows."""
        return np.asarray(np.interp(time, self.rows[TIME], self.rows[FORCE]))


def read_rod(found: Motion, scene: Scene, elements: int, separated: bool) -> RodReading:
    """From the samples of a march; ``elements`` of the rod; whether it has ``separated``. Raises ContactLost."""
    jumping = scene.profile.fixed_radius is not None
    rows = np.array([_rod_row(sample) for sample in found.samples]).T
    end = max(found.seen[-1][1], found.samples[-2].time)  # where rounding opens and closes it, the last of all
    if jumping:
        fronts = np.arange(0, rows.shape[1], 2 * elements, dtype=np.intp)
        if separated and _ended_by(rows[FORCE], fronts[-1]):
            rows = rows[:, : fronts[-1] + 1]
            end, rows = rows[TIME, -1], np.hstack([rows, rows[:, -1:]])
        rows = with_fronts(rows, fronts, SPOILED)
        rows[FORCE, 0] = _first_force(scene)
    if separated:
        rows = _rod_ended(rows, end if jumping else _undented(rows), scene.gravity)
    else:
        rows = stopped(rows, scene.end_time)
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


def _first_force(scene: Scene) -> float:
    """Z v of a flat end at touch, N, whatever the material relaxes afterwards: what so few steps tell of it jitters."""
    rod, material = scene.target, scene.geometry.material
    assert isinstance(rod, Rod)
    return rod.impedance(material.uniaxial_modulus().glassy, material.density or 0.0) * scene.velocity


def _rod_row(sample: Sample) -> tuple[float, ...]:
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


def _rod_ended(rows: Array, end: float, gravity: float) -> Array:
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
    top = _first_of_equals(rows[FORCE])
    return float(rows[TIME, top]), float(rows[FORCE, top])


def _first_of_equals(force: Array) -> int:
    """The first row as high as any but for rounding: a force that stays as it is has its peak where that begins."""
    return int(np.argmax(force >= (1.0 - ROUNDING) * force.max()))


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


def read_bar(
    found: Motion, total: float, scene: Scene, pause: float, echo: float, steps: int | None, first_force: float
) -> tuple[RodReading, Contacts]:
    """Rows up to the last separation and every contact; ``total`` mass, kg; those within a ``pause``, s, are one.

    ``echo``: time, s, after which a front comes back; ``steps`` in it, None where they do not follow it;
    ``first_force``: at touch, N, where a material has not begun to relax.
    Impulse and history are those of all contacts, the other quantities those of the first.
    """
    rows = np.array([_bar_row(sample) for sample in found.samples]).T
    spans = clustered(found.seen, pause)
    blurred, relaxed = list[tuple[float, float]](), 0.0
    if scene.motion.impacts > 1:
        rows, blurred = _cleaned(rows, spans, echo)
        relaxed, rows[FORCE, 0] = abs(first_force - float(rows[FORCE, 0])), first_force
    elif steps:
        rows = with_fronts(rows, np.arange(steps, rows.shape[1] - 2, steps), spoiled=0)
    separated, lingers = len(spans) == scene.motion.impacts and rows[FORCE, -1] <= 0.0, 0.0
    if separated:
        opened = spans[-1][1]
        rows, end = _bar_ended(rows, opened)
        spans[-1], lingers = (spans[-1][0], end), max(opened - end, 0.0)
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
    return RodReading(rows, total, separated, quantities, lingers, tuple(blurred), relaxed), contacts


def clustered(contacts: tuple[tuple[float, float], ...], pause: float) -> list[tuple[float, float]]:
    """Contacts that follow each other within a pause, s, as one."""
    found = list[tuple[float, float]]()
    for start, end in contacts:
        if found and start - found[-1][1] < pause:
            found[-1] = (found[-1][0], end)
        else:
            found.append((start, end))
    return found


def _bar_row(sample: Sample) -> tuple[float, ...]:
    """A bar has no dent: in its place stands the gap to the plane, below zero."""
    return sample.time, float(sample.displacement[0]), float(sample.velocity[0]), sample.force, float(sample.overlap[0])


def _bar_ended(rows: Array, end: float) -> tuple[Array, float]:
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


def _cleaned(rows: Array, spans: list[tuple[float, float]], echo: float) -> tuple[Array, list[tuple[float, float]]]:
    """Forces without the ringing of the first element at both ends of every contact and at fronts within the first, but
    a line through what lies beside, and the times between which that is so. There the force jumps: two rows of one time
    at every end within the rows. Where a contact opens beside its end, no line through there tells of its force.
    """
    time, cleaned, edges, blurred = rows[TIME], rows.copy(), list[Array](), list[tuple[float, float]]()
    for number, span in enumerate(spans):
        ends = [(edge, RINGING) for edge in span] if number else _fronts(time, span, echo)
        for (start, behind), (end, _) in pairwise(ends):
            pressed = np.flatnonzero((time >= start) & (time <= end))
            if pressed.size < behind + RINGING + 2 * CLEAR:
                continue
            for ordered, edge, ringing in ((pressed, start, behind), (pressed[::-1], end, RINGING)):
                telling, spoiled = ordered[ringing : ringing + CLEAR], ordered[:ringing]
                if not (rows[FORCE, telling] > 0.0).all():
                    continue
                line = np.polyfit(time[telling] - start, rows[FORCE, telling], 1)
                cleaned[FORCE, spoiled] = np.maximum(np.polyval(line, time[spoiled] - start), 0.0)
                blurred.append((min(edge, *time[spoiled]), max(edge, *time[spoiled])))
                if time[0] < edge < spans[-1][1]:
                    reached = _row(rows, edge, max(float(np.polyval(line, edge - start)), 0.0))
                    apart = [_row(rows, edge, 0.0)] if edge in span else []
                    edges += [reached, *apart] if edge == end else [*apart, reached]
    places = np.searchsorted(time, [row[TIME] for row in edges])
    return (np.insert(cleaned, places, np.array(edges).T, axis=1) if edges else cleaned), blurred


def _fronts(time: Array, first: tuple[float, float], echo: float) -> list[tuple[float, int]]:
    """Start and end of the first contact, s, and between them when what the touch sent is back; with the steps behind
    each in which the first element rings: half as many more at every return, where it rings again.

    Of those too close to tell forces apart the first counts. Later contacts meet fronts from all touches and
    separations before, which lie anywhere.
    """
    found = [(first[0], RINGING)]
    for times in range(1, math.ceil((first[1] - first[0]) / echo)):
        front, behind = first[0] + echo * times, RINGING + RINGING // 2 * times
        last, at, end = np.searchsorted(time, [found[-1][0], front, first[1]])
        if at - last > found[-1][1] + RINGING + 2 * CLEAR and end - at > behind + RINGING + 2 * CLEAR:
            found.append((front, behind))
    return [*found, (first[1], RINGING)]


def _row(rows: Array, time: float, force: float) -> Array:
    """What was at a time, s, with another force, N."""
    found = np.array([np.interp(time, rows[TIME], row) for row in rows])
    found[[TIME, FORCE]] = time, force
    return found


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
    top = _first_of_equals(np.where(inside, rows[FORCE], 0.0))
    return {
        "start": start,
        "duration": end - start,
        "velocity": came,
        "restitution": -left / came,
        "peak_force": float(rows[FORCE, top]),
        "peak_time": float(rows[TIME, top]),
        "peak_depth": float(rows[DEPTH, inside].max()),
    }
