"""From a law's dense answer to a Result: the same rows, bars and keys for every law."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Protocol

import numpy as np

from lumped.numbers import ROUNDED_TIME, Array, Clock, rounded_by_time
from lumped.result.history import AT_REST, End, History, densified
from lumped.result.model_ledger import Ledger, Peak
from lumped.result.result import RULED_RELATIVE, UNITS, Quantity, Result, provenance, unmet
from lumped.scene.scene import Scene
from lumped.scene.tables import Model
from lumped.schema import Table

if TYPE_CHECKING:  # the row of springs needs numpy alone
    from lumped.solvers.point.track import Outcome

# Rounding of the sums behind a quantity, relative to it.
ROUNDING = 1e-12
DIGITS = 4e-15  # rounding: of a depth after all the steps in which a force falls, relative to it
LAST_DIGIT = 1e-15  # rounding: of a depth, and of what an impulse is the difference of, relative to it
# A peak is flat: its time is known to the root of what its height is known to.
ROUNDING_OF = {"peak_time": 1e-8}
# Where two integrations are compared for the time of a peak: how the force bends there is told by so many places up to
# so many rows on either side; what they differ by, within reaches of which each is this share of the one before.
ROWS_AROUND, SHRUNK = 2, 0.8
AROUND = np.linspace(0.0, 1.0, 17)
# By these the values at AROUND give the square's coefficient of the parabola that fits them best.
_EVEN = (AROUND - 0.5) ** 2 - np.mean((AROUND - 0.5) ** 2)
BENDS = _EVEN / (_EVEN @ _EVEN)
EQUAL = 1e-9  # rounding: peaks of several contacts that differ by less, relatively, are one height
FINEST_ROWS = 1e-9  # work: a history is made no denser than this share of the peak force asks for
SHARE_OF_CONTACT = 1e-3  # safety: in what is shorter than this share of a contact nothing but a jump is left out
# Two integrations may agree in one quantity by chance: its bar is at least this share of the history's (L2).
LEAST_SHARE = 0.1


class Columns(Protocol):
    """What a law says of times (n,), s, in SI."""

    def __call__(self, times: Array) -> Array:
        """Depth, velocity, force and contact radius, shape (4, n)."""

    def force(self, times: Array) -> Array:
        """The force alone, shape (n,): sooner told, and asked for more often."""


@dataclass(frozen=True)
class Answer:
    """One integration of a law.

    `columns` tells it at any time, `times` are its own rows; `values` are the quantities (None where undefined),
    without history_l2. `until`: the last time to follow, s; None: the scene's. `contacts`: the several contacts of one
    motion. `mass`: what moves, kg, by which the impulse goes with the velocity; 0 where waves carry some of it.
    `stiff`: the largest stiffness times its depth, N; `momentum`: of what the impulse is the difference, N s;
    `rounded`: what the last digits of depths and rates change of a quantity, SI; `late`: the same of when each of
    several contacts begins, s, and the force with which it does, N.
    """

    times: Array
    columns: Columns
    values: Mapping[str, float | None]
    end: End
    energy: Mapping[str, float | None] = field(default_factory=dict)
    message: str = ""
    until: float | None = None
    contacts: tuple[Mapping[str, float | None], ...] = ()
    mass: float = 0.0
    stiff: float = 0.0
    momentum: float = 0.0
    rounded: Mapping[str, float] = field(default_factory=dict)
    late: tuple[tuple[float, float], ...] = ()

    @property
    def rounding(self) -> float:
        """What rounding adds to every bar, relatively; and what calling the striker at rest adds."""
        return ROUNDING + (AT_REST if self.end is End.REST else 0.0)

    def rows(self, scene: Scene) -> Array:
        """Its own times, and those until the end which a striker at rest has still before it."""
        if self.end is not End.REST:
            return self.times
        return np.append(self.times, [self.times[-1] * (1.0 + 1e-9), self.until or scene.end_time])


def impulse_of(scene: Scene, end: End, velocity: float, time: float, until: float) -> float | None:
    """What the force has passed on by the last row, N s: the momentum lost, and what gravity gave meanwhile.

    `velocity`, m/s, at `time`, s, is the last one; at rest the weight is borne `until` then. None where a second
    approach was not followed.
    """
    if end is End.SECOND_APPROACH:
        return None
    lost, lasted = (scene.velocity, until) if end is End.REST else (scene.velocity - velocity, time)
    return float(scene.reduced_mass * (lost + scene.gravity * lasted))


def values_of(
    scene: Scene, end: End, peak: tuple[float, float], deepest: float, velocity: float, time: float
) -> dict[str, float | None]:
    """Those of one contact followed to `time`, s, with the `velocity`, m/s, of then; `peak`: its time, s, and force."""
    separated = end is End.SEPARATED
    return {
        "peak_force": peak[1],
        "peak_time": peak[0],
        "peak_depth": deepest,
        "duration": time if separated else None,
        "restitution": -velocity / scene.velocity if separated else None,
        "impulse": impulse_of(scene, end, velocity, time, scene.end_time),
    }


def values_of_several(contacts: Sequence[Outcome], impulse: float | None) -> dict[str, float | None]:
    """Those of contacts in a row: the largest of all, but duration and restitution of the first one.

    Of peaks as high as one another, but for rounding, the first.
    """
    most = max(one.peak_force for one in contacts)
    highest = next(one for one in contacts if one.peak_force >= (1.0 - EQUAL) * most)
    return {
        "peak_force": highest.peak_force,
        "peak_time": highest.peak_time,
        "peak_depth": max(one.peak_depth for one in contacts),
        "duration": contacts[0].duration,
        "restitution": contacts[0].restitution,
        "impulse": impulse,
    }


def bars(fine: Answer, coarse: Answer, safety: float) -> tuple[dict[str, Quantity], float]:
    """The quantities of `fine`, each with `safety` times its distance from `coarse` as bar; the bar of F, N."""
    times, near = _times_of_both(fine, coarse), _NearPeak.of(fine)
    places = np.append(times, near.places)  # both are asked once for all of them
    force = fine.columns.force(places)
    missed = force - coarse.columns.force(places)
    worst, l2 = _largest_and_norm(fine, times, force[: times.size], missed[: times.size])
    passed = _impulse_missed(fine, coarse, times)
    steep, late = _rounded(fine, times, force[: times.size])
    rounded = max(fine.rounding, late, fine.rounded.get("history_l2", 0.0))
    quantities = {"history_l2": Quantity(0.0, safety * l2 + rounded, "1")}
    for name, value in fine.values.items():
        other, error = coarse.values[name], None
        if value is not None:
            scale = 1.0 if name == "restitution" else abs(value)
            least = LEAST_SHARE * l2 + fine.rounding + ROUNDING_OF.get(name, 0.0)
            error = max(abs(value - (other or 0.0)), least * scale, fine.rounded.get(name, 0.0))
            if name == "impulse":
                error = max(error, passed, LAST_DIGIT * fine.momentum)
            if name == "peak_time":
                error = near.shift(force[times.size :], missed[times.size :], error)
            error *= safety
        quantities[name] = Quantity(value, error, UNITS[name])
    peak = fine.values["peak_force"] or 0.0
    return {name: quantities[name] for name in UNITS}, safety * (
        worst + max(fine.rounding * peak, steep, DIGITS * fine.stiff)
    )


def _times_of_both(fine: Answer, coarse: Answer) -> Array:
    """Their own rows; where the force jumps, at an end, the two know it to rounding: of times as close the first.

    After long flights rounding of time is no small share of a contact: there nothing is left out.
    """
    t = np.sort(np.concatenate([fine.times, coarse.times]))
    lasted = (one["duration"] or math.inf for one in fine.contacts)
    close = min(ROUNDING * float(t[-1]), SHARE_OF_CONTACT * min(lasted, default=math.inf))
    return np.asarray(t[np.append(True, np.diff(t) > close)])


def _impulse_missed(fine: Answer, coarse: Answer, times: Array) -> float:
    """The mass times the largest difference of two velocities at these times, N s, where an end cuts a contact: there
    the two may meet by chance. Where the contact ends by itself nothing.
    """
    if fine.end is not End.TIME or not fine.mass:
        return 0.0
    return fine.mass * float(np.abs(fine.columns(times)[1] - coarse.columns(times)[1]).max())


def _largest_and_norm(fine: Answer, times: Array, force: Array, missed: Array) -> tuple[float, float]:
    """Largest difference of two forces over time, N, and its L2 norm over that of the force."""
    apart, norm = _squared(fine, times, missed), _squared(fine, times, force)
    return float(np.abs(missed).max()), math.sqrt(apart / norm) if norm else 0.0


def _squared(fine: Answer, times: Array, force: Array) -> float:
    """Twice the integral of the square of a force over the contacts, N2 s.

    Where rows that rounding cannot tell apart are left out, and the force jumps at the end of a contact, a line from
    there would lead through all the flight.
    """
    steps = np.diff(times)
    if fine.contacts:
        middle = times[:-1] + 0.5 * steps
        starts = np.array([one["start"] for one in fine.contacts], dtype=float)
        lasted = np.array([math.inf if one["duration"] is None else one["duration"] for one in fine.contacts])
        number = np.maximum(np.searchsorted(starts, middle, side="right") - 1, 0)
        steps = steps * (middle - starts[number] <= lasted[number])
    return float(steps @ (force[1:] ** 2 + force[:-1] ** 2))


def _rounded(fine: Answer, times: Array, force: Array) -> tuple[float, float]:
    """By how much rounding of these times shifts a force at most, N, and its L2 norm over that of the force.

    What is rounded of a speed is carried through the flight that follows, however long that lasts. What changes within
    rows that rounding cannot tell apart, as at a touch, may do so as much sooner or later as a whole.
    """
    rounded, steps, change = ROUNDED_TIME * times[1:], np.diff(times), np.abs(np.diff(force))
    jumped = 0.0
    if fine.late:
        starts = np.array([one["start"] for one in fine.contacts], dtype=float)
        late, jumps = np.array(fine.late).T
        rounded += late[np.searchsorted(starts, times[1:], side="right") - 1]
        jumped = float((ROUNDED_TIME * starts + late) @ jumps**2)
    shifted = rounded_by_time(times, force, rounded)
    close = steps < rounded
    together = np.cumsum(~close)  # rows that rounding cannot tell apart have one number
    at_once, width = np.bincount(together, change * close), np.zeros(int(together.max(initial=0)) + 1)
    np.maximum.at(width, together, rounded * close)
    moved = jumped + float((steps * ~close) @ shifted**2) + float(width @ at_once**2)
    norm = _squared(fine, times, force)
    return float(shifted.max(initial=0.0)), math.sqrt(2.0 * moved / norm) if norm else 0.0


def wider(one: Mapping[str, Quantity], other: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """The same quantities, each with the wider of its two bars."""
    return {name: max(quantity, other[name], key=lambda known: known.error or 0.0) for name, quantity in one.items()}


@dataclass(frozen=True, eq=False)
class _NearPeak:
    """Where two forces are looked at to tell by how much the peak of the first may lie elsewhere.

    ``places``, s: AROUND the peak over a ``width``, and to both sides of it at ``reaches``, of which none is longer
    than the ``whole`` contact, and at itself. None of all this at touch, and at an end.
    """

    whole: float
    width: float
    reaches: Array
    places: Array

    @classmethod
    def of(cls, answer: Answer) -> _NearPeak:
        """About the peak of an answer, as near as rounding lets it be known."""
        times, peak = np.unique(answer.times), answer.values["peak_time"] or 0.0
        i, whole = int(np.searchsorted(times, peak)), float(times[-1])
        low, high = times[max(i - ROWS_AROUND, 0)], times[min(i + ROWS_AROUND, times.size - 1)]
        if not low < peak < high:
            return cls(whole, 0.0, np.empty(0), np.empty(0))
        reaches = np.asarray(whole * SHRUNK ** np.arange(_count(ROUNDING_OF["peak_time"] * peak / whole)), dtype=float)
        sides = np.clip(peak + np.outer([-1.0, 1.0], np.append(reaches, 0.0)), 0.0, whole)
        return cls(whole, high - low, reaches, np.append(low + (high - low) * AROUND, sides))

    def shift(self, force: Array, missed: Array, least: float) -> float:
        """By how much the peak may lie elsewhere, s: where the force falls short of it by less than what is missed
        changes between here and there; both at ``places``.

        Not sought any closer than the `least`; at most the whole contact; the least at touch, and at an end.
        """
        if not self.places.size:
            return least
        bent = -2.0 * float(BENDS @ force[: AROUND.size]) / self.width**2
        if bent <= 0.0:
            return max(self.whole, least)
        reaches = self.reaches[: _count(least / self.whole)]
        sides = missed[AROUND.size :].reshape(2, -1)[:, [*range(reaches.size), -1]][:, ::-1]
        spread = np.maximum.accumulate(sides.max(axis=0)) - np.minimum.accumulate(sides.min(axis=0))
        shifts = np.sqrt(2.0 * spread[:0:-1] / bent)  # the farthest that what they differ by within each reach allows
        last = np.append(shifts[:-1] > reaches[1:], True).argmax()  # the next reach would be too short for it
        return max(min(float(shifts[last]), self.whole), least, self._as_high(force[AROUND.size :]))

    def _as_high(self, force: Array) -> float:
        """How far on one side the force is as high as at the peak but for its last digit, s: `force` at the reaches.

        A peak is flatter on one side where a law yields until the motion turns and then gives way.
        """
        sides = force.reshape(2, -1)
        level = sides[:, :-1].max(axis=0) >= (1.0 - np.finfo(float).eps) * sides[0, -1]
        return float(self.reaches[level.argmax()]) if level.any() else 0.0


def _count(share: float) -> int:
    """Of reaches, until one is shorter than this share of the whole."""
    return 2 + max(math.ceil(math.log(share, SHRUNK)), 0)


def assemble(
    method: str,
    scene: Scene,
    tolerance: float,
    answer: Answer,
    quantities: Mapping[str, Quantity],
    force_error: float,
    clock: Clock,
    numerics: Table,
    work: Mapping[str, float],
    model: Model | None = None,
    dense: bool = True,
) -> Result:
    """The Result of one law: history, ledgers, and what it cost.

    `model` is the model as the law resolves it, where that is not the scene's with small displacements and
    without inertia. The history is `dense` enough for the tolerance, or has the answer's own rows.
    """
    times = answer.rows(scene)
    if dense:
        times = densified(times, answer.columns.force, max(tolerance, FINEST_ROWS))
    depth, velocity, force, radius = answer.columns(times)
    depth[0], velocity[0] = 0.0, scene.velocity  # the touch, which the polynomials know to rounding
    # The rows themselves add what linear interpolation errs by, less than the tolerance; the bar is for the
    # rows.
    history = History(times, depth, velocity, force, radius, np.full(times.size, force_error))
    resolved = model or small_model(scene.model)
    missed = unmet(quantities, tolerance)
    peak = quantities["peak_force"].value or 1.0
    return Result(
        method=method,
        converged=answer.end is not End.SECOND_APPROACH and not missed,
        separated=answer.end is End.SEPARATED,
        scene=scene,
        model=resolved,
        tolerance=tolerance,
        history=history,
        quantities=quantities,
        numerics=numerics,
        error_budget={"integration": force_error / peak},
        error_budget_by_quantity={"integration": _relative(quantities)},
        model_ledger=Ledger(scene, Peak.of(quantities, history), resolved),
        energy=answer.energy,
        provenance=provenance(),
        timing=clock.read(),
        work=work,
        message="; ".join(part for part in (answer.message, missed) if part),
        contacts=answer.contacts,
    )


@lru_cache(maxsize=16)  # of many impacts it is the same
def small_model(model: Model) -> Model:
    """The model with small displacements, without inertia and without plastic flow."""
    return replace(model, inertia=False, kinematics="small", plasticity=False)


def _relative(quantities: Mapping[str, Quantity]) -> dict[str, float]:
    """Bars over values where the tolerance rules them so."""
    found = {}
    for name, quantity in quantities.items():
        if quantity.error is not None and quantity.value is not None:
            relative = name in (*RULED_RELATIVE, "peak_time") and quantity.value != 0.0
            found[name] = quantity.error / abs(quantity.value) if relative else quantity.error
    return found
