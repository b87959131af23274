"""Depth, rate and force of a motion at any times, from the polynomials of its steps; and what one contact comes to."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumped.numbers import Array
from lumped.result.history import End
from lumped.solvers.point.bodies import PointLaw, Step
from lumped.solvers.point.contact import Contact, PointMotion
from lumped.solvers.point.phase import PointPhase
from lumped.solvers.radau import STAGES, place_of

# How near to a touch the rows begin, as a power of 1/2, in the length of its step.
NEAREST = 96.0
IN_FLIGHT = 17  # look: rows of a flight, its ends among them
# Share of a step within which its first depth and the mean rate tell the depth better than its polynomial.
EARLY = 1e-6
# Half the widths of the quartics through which a peak is found, in that of its surroundings, and their points.
CLOSER = (0.5, 0.1, 0.03)
FIVE = np.linspace(0.0, 1.0, 5)  # places through which the quartic is laid
QUARTIC = np.linalg.inv(np.vander(FIVE))
AT_END = 1e-9  # rounding: of the time since touch, by which a flat peak is known to lie before the end of a step
NEWTONS = 8  # work: steps to the top of a quartic


class PointRow(NamedTuple):
    """The steps of a stage side by side, n of them: starts and lengths, s, and what their nodes are, shape (n,).

    `depths` and `rates` are those at their starts. `series`, shape (n, 2, s + 1), are the Legendre coefficients of
    depth and rate over the place.
    """

    starts: Array
    lengths: Array
    depths: Array
    rates: Array
    powers: Array
    begun: Array
    mirrored: NDArray[np.bool_]
    series: Array
    graded: bool

    @classmethod
    def of(cls, phase: PointPhase) -> PointRow:
        """Those of a phase."""
        lengths = np.array([step.length for step in phase.steps])
        starts = phase.times[:-1]
        depths, rates = np.array([step.start[:2] for step in phase.steps]).T
        powers = np.array([float(step.nodes.power) for step in phase.steps])
        begun = np.array([step.nodes.begun for step in phase.steps])
        mirrored = np.array([step.nodes.mirrored for step in phase.steps])
        series = np.array([_series(step) for step in phase.steps])
        return cls(starts, lengths, depths, rates, powers, begun, mirrored, series, bool((powers > 1.0).any()))


@dataclass(frozen=True)
class PointTrack:
    """A motion under its law, dense in time."""

    law: PointLaw
    motion: PointMotion

    @cached_property
    def times(self) -> Array:
        """Where its steps begin and end, s, ascending; the force may jump at touch, so the instant before is there."""
        ends = [phase.times for phase in self._phases]
        touches = np.array([contact.start_time for contact in self.motion.contacts[1:]])
        parted = np.array([contact.end_time for contact in self.motion.contacts[:-1]])
        return np.unique(np.concatenate([*ends, np.nextafter(touches, 0.0), np.nextafter(parted, np.inf)]))

    @cached_property
    def rows(self) -> Array:
        """Its times, some of each flight, and ever more towards a touch or an end of depth, where forces are steep."""
        close = [self.times]
        for one, following in pairwise(self.motion.contacts):
            close.append(np.linspace(one.end_time, following.start_time, IN_FLIGHT))
        for phase in self._phases:
            for start, step in zip(phase.times, phase.steps, strict=False):
                power, begun, mirrored = step.nodes.power, step.nodes.begun, step.nodes.mirrored
                if power > 1 and begun == 0.0:
                    share = step.length * 2.0 ** (-power * np.arange(1.0, NEAREST / power))
                    close.append(start + step.length - share if mirrored else start + share)
        return np.unique(np.concatenate(close))

    def __call__(self, times: Array) -> Array:
        """Depth, m, rate, m/s, and force, N, at `times`, shape (n,) from zero on: shape (3, n).

        Where two contacts or stages meet the later one speaks, but the end of a contact is its own.
        """
        found = np.zeros((3, times.size))
        for contact in self.motion.contacts:
            self._fly(found, times, contact)
        for phase in self._phases:
            inside = (times >= phase.start_time) & (times <= phase.end_time)
            if inside.any():
                found[:, inside] = self.pressed(phase, times[inside])
        return found

    @cached_property
    def _phases(self) -> list[PointPhase]:
        return [phase for contact in self.motion.contacts for phase in contact.phases]

    def row(self, phase: PointPhase) -> PointRow:
        """The steps of one of its phases."""
        return self._rows[id(phase)]

    @cached_property
    def _rows(self) -> dict[int, PointRow]:
        return {id(phase): PointRow.of(phase) for phase in self._phases}

    def _fly(self, found: Array, times: Array, contact: Contact) -> None:
        """Free flight, or rest, from the end of a contact on, until a later one overwrites it."""
        after = times > contact.end_time
        if not after.any():
            return
        elapsed = times[after] - contact.end_time
        last, gravity = contact.last, self.motion.gravity
        if contact.end is End.REST:
            # what a damper still adds where the striker counts as at rest dies away
            found[:, after] = np.array([[last.depth], [0.0], [self.motion.weight]])
            return
        found[0, after] = last.depth + elapsed * (last.rate + 0.5 * gravity * elapsed)
        found[1, after] = last.rate + gravity * elapsed
        found[2, after] = 0.0

    def pressed(self, phase: PointPhase, times: Array) -> Array:
        """The columns at times within one of its phases, shape (3, n)."""
        row = self.row(phase)
        which = np.maximum(np.searchsorted(row.starts, times, side="right") - 1, 0)
        elapsed = times - row.starts[which]
        share = np.minimum(elapsed / row.lengths[which], 1.0)
        place = place_of(share, row.powers[which], row.begun[which], row.mirrored[which]) if row.graded else share
        depth, rate = np.einsum("kn,njk->jn", legendre_terms(2.0 * place - 1.0), row.series[which])
        # Forces may rise with a small power of the depth: after a touch all digits of it count.
        mean = 0.5 * (row.rates[which] + rate)
        depth = np.where(share < EARLY, row.depths[which] + elapsed * mean, depth)
        return np.array([depth, rate, self.law.between(phase.steps, which, share, depth, rate, phase.stage)])


def legendre_terms(x: Array) -> Array:
    """P_0 to P_s at places x in [-1, 1], shape (n,): shape (s + 1, n)."""
    terms = np.empty((STAGES + 1, x.size))
    terms[0], terms[1] = 1.0, x
    for k in range(1, STAGES):
        terms[k + 1] = ((2 * k + 1) * x * terms[k] - k * terms[k - 1]) / (k + 1)
    return terms


def _series(step: Step) -> Array:
    """The coefficients of depth and rate: their slopes over the place integrated from the start of the step."""
    slopes = np.array([step.nodes.pace * step.rate, step.gain])
    series = step.length * (slopes @ step.nodes.series.T @ step.nodes.first)
    series[:, 0] += step.start.depth, step.start.rate
    return np.asarray(series)


class Outcome(NamedTuple):
    """One contact in SI units; `start` and `peak_time` since first touch; None where it did not end."""

    start: float
    duration: float | None
    velocity: float
    restitution: float | None
    peak_force: float
    peak_time: float
    peak_depth: float


def outcome_of(track: PointTrack, one: Contact) -> Outcome:
    """The outcome of one contact of a track."""
    separated = one.end is End.SEPARATED
    peak_time, peak_force = peak_of(track, one)
    return Outcome(
        one.start_time,
        one.end_time - one.start_time if separated else None,
        one.first.rate,
        -one.last.rate / one.first.rate if separated and one.first.rate > 0.0 else None,
        peak_force,
        peak_time,
        one.deepest,
    )


def peak_of(track: PointTrack, one: Contact) -> tuple[float, float]:
    """Time, s, and height, N, of the highest force of a contact."""
    steps = [(phase, step) for phase in one.phases for step in phase.steps]
    ends = one.start_time + np.cumsum([step.length for _, step in steps])
    i = int(np.argmax([step.force.max() for _, step in steps]))
    touch = float(track.pressed(one.phases[0], np.array([one.start_time]))[2, 0])

    def highest(k: int) -> tuple[float, float]:
        phase, step = steps[k]
        return _vertex(track, phase, ends[k] - step.length * (1.0 - np.append(0.0, step.nodes.points)))

    top, last = highest(i), steps[i][1]
    # A faint damper lets the force turn just before the motion: only what still rises at an end is higher after it.
    at_end = ends[i] - top[0] <= AT_END * (ends[i] - one.start_time) and last.force.argmax() == last.force.size - 1
    if at_end and last.last_slope(last.force) > 0.0 and i + 1 < len(steps):
        top = highest(i + 1)
    return max((one.start_time, touch), top, key=lambda peak: peak[1])


def _vertex(track: PointTrack, phase: PointPhase, places: Array) -> tuple[float, float]:
    """The highest force between the first and the last of ascending places: the top of ever narrower quartics."""
    values = track.pressed(phase, places)[2]
    i = int(np.argmax(values))
    first, last = float(places[max(i - 1, 0)]), float(places[min(i + 1, places.size - 1)])
    time, height = 0.5 * (first + last), 0.0
    for share in CLOSER:
        left, right = max(time - share * (last - first), first), min(time + share * (last - first), last)
        place, height = _top(track.pressed(phase, left + (right - left) * FIVE)[2])
        time = left + (right - left) * place
    return time, height


def _top(values: Array) -> tuple[float, float]:
    """The place in [0, 1] and the height of the top of the quartic with these values at FIVE, by Newton's method."""
    quartic, place = (QUARTIC @ values).tolist(), float(FIVE[values.argmax()])
    for _ in range(NEWTONS):
        _, tilt, bent = _horner(quartic, place)
        place = min(max(place - tilt / bent, 0.0), 1.0) if bent < 0.0 else place
    return place, _horner(quartic, place)[0]


def _horner(polynomial: list[float], place: float) -> tuple[float, float, float]:
    """Value, slope and curvature of a polynomial, highest power first: Horner's scheme and its derivatives."""
    value, slope, half_bent = 0.0, 0.0, 0.0
    for coefficient in polynomial:
        half_bent = half_bent * place + slope
        slope = slope * place + value
        value = value * place + coefficient
    return value, slope, 2.0 * half_bent
