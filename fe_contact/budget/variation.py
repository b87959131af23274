"""What one varied setting changes, quantity by quantity, and the error that this change stands for.

A :class:`Softening` is the error of a body that is a little too soft or too stiff everywhere alike, without a march.
On a mesh that follows the contact the far field lifts or lowers the whole contact of an elastic body by the same
share of its displacement, whatever the instant. That is a modulus which errs by this share: on the same path the force
errs by no more than it, hence so does the impulse, and with it speed and path.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from fe_contact.assembly.forms import Array
from fe_contact.budget.curve import BETWEEN, NEAREST_QUARTIC, PLACES, STENCIL, Curve, Reading
from fe_contact.steppers.struck import Deformable

TOP = 0.998  # of the largest depth or force, above which it is near: further away what comes later counts as an error
LATE = 0.75  # share of the contact from which path and speed count for those at separation
STEEPER = 2.0  # times the chord there, that the slope of a change under a flat end may have
RIPPLED = 1.5  # times its nearest quartic there that a change which ripples on a mesh may have
SMOOTHING = 0.07  # share of the contact over which a pointwise change counts as the error of its neighbours
FIRST_ORDER = 1.25  # factor where order one is all that shows
SAFETY = 1.25  # of a grid convergence index by three runs, doi:10.1115/1.2910291
FEWEST = 24  # steps that a curve keeps: a kink and both ends want as many
AT_TOUCH = 3.0  # factor in the first step: a dashpot's force begins as the root of time, which leaves order 1/2
UNORDERED = 2.5  # factor where no order shows: the finer of two runs errs by less than twice their distance


def factor(order: float, finer: bool) -> float:
    """Error over change of a setting and its half or double, SAFETY / (2^order - 1) of the better one.

    Of the first setting: ``finer`` if the second is the better one.
    """
    return SAFETY * (2**order if finer else 1) / (2**order - 1)


def largest_around(values: Array, width: int) -> Array:
    """The largest of values (n,) up to so many places away, at each."""
    padded = np.pad(values, width, mode="edge")
    return np.asarray(np.lib.stride_tricks.sliding_window_view(padded, 2 * width + 1).max(axis=1))


@dataclass(frozen=True)
class Variation:
    """Two curves that differ in one setting, and the factor that turns their difference into an error.

    ``weights``: what that factor is to be multiplied with for quantities that deserve less trust. ``unresolved``: time
    up to which no order shows, s; where it is not told, the first step of the second curve. ``near``: share of the
    largest depth above which the path counts for that. ``creeps``: whether the end is where the path meets a surface
    that creeps after it.
    """

    first: Curve
    second: Curve
    factor: float
    weights: Mapping[str, float] = field(default_factory=dict)
    unresolved: float | None = None
    since: float = LATE
    near: float = TOP
    creeps: bool = False

    @classmethod
    def between(cls, first: Curve | None, second: Curve | None, trusted: float, **more: Any) -> Self | None:
        """With ``trusted`` as factor, and ``more`` as it takes it; None where a run of either setting failed."""
        return None if first is None or second is None else cls(first, second, trusted, **more)

    @cached_property
    def errors(self) -> dict[str, float]:
        """Error of every quantity, in its unit.

        What is read at one instant takes the largest change around it: a difference of two curves may cross
        zero just there, which makes neither of them right.
        """
        first, depth = self.first, np.abs(self._depth_change)
        around = {
            "peak_force": self._peak_force,
            "peak_time": self._peak_time,
            "peak_depth": float(depth[first.dense.depth > self.near * first.dense.depth.max()].max()),
            "duration": self._duration,
            "impulse": self.impulse,
            "restitution": self.velocity / first.strike.velocity,
        }
        errors = {name: self._error(name, value) for name, value in around.items()}
        return errors | {"history_l2": self.factor * self.history}

    @cached_property
    def energies(self) -> dict[str, float]:
        """Error of every term of the energy account, J; of what the striker takes along by the velocity's."""
        first, second = self.first.energy, self.second.energy
        strike, factor = self.first.strike, self.factor * self._weight("restitution")
        speed = factor * self.velocity
        errors = {name: factor * abs(value - second[name]) for name, value in first.items()}
        out = strike.mass * speed * (abs(self.first.leaving_speed) + 0.5 * speed)
        return errors | {"out": max(errors["out"], out)}

    def _error(self, name: str, around: float) -> float:
        first, second = self.first.quantities[name], self.second.quantities[name]
        if first is None or second is None:
            return np.inf if first is not second else 0.0
        return self.factor * self._weight(name) * max(abs(first - second), around)

    def _weight(self, name: str) -> float:
        return self.weights.get(name, 1.0)

    def force(self, time: Array) -> Array:
        """Error of the force at times, N: the largest change in the neighbourhood of each.

        While no order shows the whole change counts, and more within the first step of all; where the path turns,
        and with it, of a viscous contact, the force's slope at once, the order is one. What steps err by there and at
        touch, motion carries along: forces of viscous contacts have the velocity's order. What is cut off may peak in
        its last step, which no later one evens out.
        """
        places, change = self._pointwise
        around = largest_around(change, round(SMOOTHING * len(change)))
        first_step = self.second.duration * self.second.x[1] ** 2
        resolved = time > (first_step if self.unresolved is None else self.unresolved)
        whole = ~resolved | self._about_turn(time)
        carried = 1.0 if self.second.strike.relaxation.is_elastic else self._weight("restitution")
        carried *= self.factor
        factor = np.where(whole, max(carried, FIRST_ORDER), carried)
        factor[time <= self.first.duration * self.first.x[1] ** 2] = max(self.factor, AT_TOUCH)
        if not self.first.separated:
            factor[time >= self.second.last_step] *= self._weight("peak_force")
        return np.asarray(factor * np.interp(time, places, around))

    def _about_turn(self, time: Array) -> npt.NDArray[np.bool_]:
        """Which times lie within two steps of the second curve from where a viscous contact turns.

        No step but the one whose change is told with its ``unresolved`` time tells of that.
        """
        if self.unresolved is None or self.second.strike.relaxation.is_elastic:
            return np.zeros(len(time), dtype=bool)
        top, last = int(self.second.depth.argmax()), len(self.second.x) - 1
        begin, end = self.second.duration * self.second.x[[max(top - 2, 0), min(top + 2, last)]] ** 2
        return np.asarray((time >= begin) & (time <= end))

    def radius(self, time: Array) -> Array:
        """How much the contact radius changes at times, m."""
        return self.first.radius_at(time) - self.second.radius_at(time)

    @cached_property
    def late(self) -> int:
        """The first of the dense times at which path and speed count for those at the end."""
        return int(np.searchsorted(self.first.shares, self.since))

    @property
    def _pointwise(self) -> tuple[Array, Array]:
        """Times, dense and within every step, and how much the force changes there, N."""
        x = self.first.x
        within = self.first.duration * (0.5 * (x[1:] + x[:-1])) ** 2
        times = np.concatenate([self.first.dense_time, within])
        order = times.argsort(kind="stable")
        change = np.abs(self.first.force(within) - self.second.force(within))
        return times[order], np.concatenate([self._force_change, change])[order]

    @cached_property
    def velocity(self) -> float:
        """Largest change of the velocity late in the contact, compared at equal shares of it, m/s."""
        return abs(self.signed_velocity)

    @cached_property
    def signed_velocity(self) -> float:
        """The same with its sign."""
        second = self.second.velocity(self.second.duration * self.first.shares, self._alike.impulse)
        late = (self.first.dense_velocity - second)[self.late :]
        return float(late[np.abs(late).argmax()])

    @cached_property
    def impulse(self) -> float:
        """The same of the impulse, N s."""
        return float(np.abs(self.first.dense.impulse - self._alike.impulse)[self.late :].max())

    @cached_property
    def history(self) -> float:
        """Norm of the force's change over the norm of the force."""
        time = self.first.dense_time
        change = np.trapezoid(self._force_change**2, time)
        return float(np.sqrt(change / np.trapezoid(self.first.dense_force**2, time)))

    @cached_property
    def _alike(self) -> Reading:
        """The second curve at equal shares of its contact."""
        if self.second.shares is self.first.shares:
            return self.second.dense
        return self.second.read(self.second.duration * self.first.shares)

    @cached_property
    def _second(self) -> Reading:
        """The second curve at the first one's times."""
        return self.second.read(self.first.dense_time)

    @cached_property
    def _force_change(self) -> Array:
        return np.abs(self.first.dense_force - self._second.force)

    @cached_property
    def _depth_change(self) -> Array:
        return self.first.dense.depth - self._second.depth

    @property
    def _duration(self) -> float:
        """Time in which the largest change of the path late in the contact is covered, s.

        Where the surface creeps, a path that is pressed deeper by a share takes it along, and both meet when they did:
        of that the end moves by no more than this share of the duration.
        """
        first, change, share = self.first, self._depth_change, 0.0
        speed = abs(first.leaving_speed) if first.separated else np.inf
        if self.creeps:
            turn = first.dense.depth.argmax()
            share = change[turn] / first.dense.depth[turn]
        late = np.abs(change - share * first.dense.depth)[self.late :].max()
        return float(late / speed + abs(share) * first.duration) if speed > 0.0 else np.inf

    @property
    def _peak_force(self) -> float:
        """Largest change of the force near its peak, N; where the peak is read from a quartic, less of what ripples."""
        largest = float(self._force_change[self.first.near_peak].max())
        if self._fitless:
            return largest
        return min(largest, RIPPLED * float(np.abs(np.polyval(self._near_peak, BETWEEN)).max()))

    @property
    def _peak_time(self) -> float:
        """How far a change of the force's slope moves its peak: slope over curvature, s.

        The curvature is that of all forces near the peak, the slope that of the change over the top: of the quartic
        nearest to it, which the peak is read from too; under a flat end, which is not read so, of its chord.
        """
        time, force = self.first.dense_time, self.first.dense_force
        top, left, right = self._about_peak
        falling = (force[top] - force[right]) / (time[right] - time[top])
        rising = (force[top] - force[left]) / (time[top] - time[left])
        curvature = 2 * (falling + rising) / (time[right] - time[left])
        high = np.flatnonzero(force > TOP * force.max())
        begin, end = min(high[0], top - 1), max(high[-1], top + 1)
        if self._fitless:
            change = self._second.force - force
            slope = STEEPER * np.ptp(change[begin : end + 1]) / (time[end] - time[begin])
        else:
            half, middle = 0.5 * (time[right] - time[left]), 0.5 * (time[right] + time[left])
            between = (np.linspace(time[begin], time[end], PLACES) - middle) / half
            slope = RIPPLED * np.abs(np.polyval(np.polyder(self._near_peak), between)).max() / half
        return float(min(slope / abs(curvature), self.first.duration)) if curvature else self.first.duration

    @property
    def _fitless(self) -> bool:
        """Whether either peak is not read from a fit."""
        return self.first.fitless or self.second.fitless

    @property
    def _about_peak(self) -> tuple[int, int, int]:
        """Dense times at the peak of the force, and before and after it where that is near its peak."""
        near = self.first.near_peak
        top = min(max(int(self.first.dense_force.argmax()), 1), len(self.first.dense_force) - 2)
        return top, min(near.start, top - 1), max(near.stop - 1, top + 1)

    @cached_property
    def _near_peak(self) -> Array:
        """The quartic nearest to the force's change between those, over -1 to 1."""
        _, left, right = self._about_peak
        places = np.linspace(self.first.dense_time[left], self.first.dense_time[right], PLACES)
        return np.asarray(NEAREST_QUARTIC @ (self.second.force(places) - self.first.force(places)))


def calmest(curve: Curve) -> Curve:
    """The curve through every other of its steps as long as its force jitters less so, down to ``FEWEST`` of them.

    On a mesh that stays, the edge crosses element after element: a dashpot's force, which is one of velocities, jitters
    by the more the shorter the step is. What it jitters by is what every other step less changes.
    """
    return _calmed(curve, Curve.thinned)


def calmest_at_corners(curve: Curve, corners: Array) -> Curve:
    """The curve evened to fewer of its steps, or read where its edge stands on ``corners`` (n,), m, as jitters less.

    Wherever the edge stands on a corner the mesh errs alike, so that from one to the next nothing jitters. Either may
    move what the force adds up to by what its rows do not tell.
    """
    even = _calmed(curve, Curve.evened)
    return min((even, _at_corners(curve, even, _crossings(curve, corners))), key=_jitter)


def _calmed(curve: Curve, fewer: Callable[[Curve], Curve]) -> Curve:
    """Of ``fewer`` steps as long as the force jitters less so, down to ``FEWEST`` of them."""
    while len(curve.x) > 2 * FEWEST:
        calmer = fewer(curve)
        if _jitter(calmer) >= _jitter(curve):
            break
        curve = calmer
    return curve


def _at_corners(curve: Curve, even: Curve, crossed: Array) -> Curve:
    """The curve read at shares ``crossed`` (n,) of the contact, from them on as the ``even`` one, before at all steps.

    Half a crossing lies between. Of fewer than a polynomial goes through nothing is read.
    """
    if len(crossed) < STENCIL:
        return even
    begin, end = crossed[0] - 0.5 * (crossed[1] - crossed[0]), crossed[-1] + 0.5 * (crossed[-1] - crossed[-2])
    before = curve.x[: max(int(np.searchsorted(curve.x**2, begin)), 1)]
    return curve.read_at(np.concatenate([before, np.sqrt(crossed), even.x[even.x**2 > end]]))


def _jitter(curve: Curve) -> float:
    """What every other row less changes."""
    return Variation(curve, curve.thinned(), 1.0).history


def _crossings(curve: Curve, corners: Array) -> Array:
    """Shares of the contact, ascending, at which the growing edge stands on corners, once no step passes several."""
    squares = np.maximum.accumulate(curve.radius_squared)
    inside = corners[(corners > 0.0) & (corners**2 < squares[-1])]
    crossed, steps = np.interp(inside**2, squares, curve.radius_x**2), curve.x**2
    short = np.flatnonzero(np.diff(crossed) < np.interp(crossed[1:], steps[1:], np.diff(steps)))
    return np.asarray(crossed[short[-1] + 1 if short.size else 0 :])


@dataclass(frozen=True)
class Softening:
    """A curve and the share by which the compliance behind it may err."""

    curve: Curve
    share: float

    @cached_property
    def errors(self) -> dict[str, float]:
        """Error of every quantity, in its unit; of the duration by the time in which the path's error is covered."""
        curve, values = self.curve, self.curve.quantities
        depth, impulse, restitution = values["peak_depth"] or 0.0, values["impulse"] or 0.0, values["restitution"]
        late = max(curve.duration, depth / curve.leaving_speed) if curve.separated else 0.0
        whole = {
            "peak_force": values["peak_force"] or 0.0,
            "peak_time": curve.duration,
            "peak_depth": depth,
            "duration": late,
            "restitution": 0.0 if restitution is None else 1.0 + restitution,
            "impulse": impulse,
            "history_l2": 1.0,
        }
        return {name: self.share * value for name, value in whole.items()}

    @cached_property
    def energies(self) -> dict[str, float]:
        """Error of every term of the energy account, J: of all work that the force does on the way in and out.

        What is given errs by the path's error under gravity alone.
        """
        energy, strike = self.curve.energy, self.curve.strike
        given = abs(energy["in"] - 0.5 * strike.mass * strike.velocity**2)
        return dict.fromkeys(energy, self.share * (energy["in"] + energy["out"])) | {"in": self.share * given}

    def force(self, time: Array) -> Array:
        """Error of the force at times, N: at each what it is at the peak, since the force may be shifted, too."""
        return np.full_like(time, self.errors["peak_force"])


def compliance_change(first: Deformable, second: Deformable) -> float:
    """Relative change of the force at a held depth between two surfaces, one of which lifts the contact by a constant.

    A lift of c force/(modulus radius) changes the force by 2 c of it, whatever the profile, since dF/d(depth) = 2 E* a;
    the work of Hertz' pressure on its own displacement it changes by 5/3 c. Work is compared, since a mesh errs in
    it by the square of what it errs in displacement.
    """
    before, after = (_work(surface) for surface in (first, second))
    return 1.2 * abs(after / before - 1.0)


def _work(surface: Deformable) -> float:
    """Work of the pressure sqrt(1 - r^2) on the displacement that it causes."""
    operator = surface.operator
    load = operator.trace.T @ (operator.weights * np.sqrt(np.maximum(1.0 - operator.points**2, 0.0)))
    return float(load @ operator.response[: load.size] @ load)
