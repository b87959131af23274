"""What a comparison reads off the finite-element reference: how far a candidate is from its force, radius and pressure.

And whether Ting's solution applies: the contact grows to one maximum and shrinks through the areas it grew through. His
condition pairs every instant t of the rebound with one t1 of the approach (1966, doi:10.1115/1.3625192),

    int_t1^t E*(t - s) d(depth) = 0 ,    contact radius at t = contact radius at t1 .

Motion and radius are those of finite elements; only the modulus is taken from the scene, so that the condition is put
to the test and not used.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget.variation import Variation
from fe_contact.fields import felt, nearest_step
from fe_contact.reference import Solved
from fe_contact.studies.compare.law_pressure import LawPressure
from lumped.materials import Relaxation
from lumped.result.history import History
from lumped.result.result import Result
from lumped.result.score import Curve as Measured
from lumped.scene.scene import Scene

REBOUND_SHARES = (0.75, 0.5, 0.25)  # of the force at maximum depth: instants at which pressures are compared
RADIUS_UNTIL = 0.95  # of the shorter contact: later the radius falls like a root and shows the duration again
PRESSURE_POINTS = 240  # radii at which pressures are compared
ROUNDING = 1e-9  # of the contact, by which the times of one jump may differ
INSTANTS = 40  # of the rebound, at which radii are paired
# Of the rebound: at its beginning both radii are the largest, at its end they fall like a root.
FIRST, LAST = 0.02, 0.95
OverTime = Callable[[Array], Array]


@dataclass(frozen=True, eq=False)
class Told:
    """Times (n,), s, that follow the contact closely, with depth, m, and force, N, there; ``duration``, s; force, N,
    contact radius, m, and the force's error, N, at any times; error of the history, norm over norm.
    """

    time: Array
    depth: Array
    peak: float
    duration: float
    force: OverTime
    radius: OverTime
    force_error: OverTime
    history_error: float

    @classmethod
    def by(cls, solved: Solved) -> Told:
        """By the curve through the steps of a march."""
        certified, curve = solved.certified, solved.certified.curve
        return cls(
            time=curve.dense_time,
            depth=curve.dense.depth,
            peak=float(curve.dense_force.max()),
            duration=curve.duration,
            force=curve.force,
            radius=curve.radius_at,
            force_error=certified.force_error,
            history_error=certified.total("history_l2"),
        )

    @classmethod
    def of(cls, reference: Result) -> Told:
        """By the rows of its history."""
        history = reference.history
        return cls(
            time=history.time,
            depth=history.depth,
            peak=float(history.force.max()),
            duration=float(history.time[-1]),
            force=history.force_at,
            radius=lambda time: np.interp(time, history.time, history.contact_radius),
            force_error=lambda time: np.interp(time, history.time, history.force_error),
            history_error=reference.quantities["history_l2"].error or 0.0,
        )

    @property
    def deepest(self) -> float:
        """Time of the maximum depth, s."""
        return float(self.time[np.argmax(self.depth)])


def force_errors(told: Told, candidate: History | Measured) -> dict[str, float | None]:
    """``held_until_max_depth`` relative to the reference's peak; ``history``, norm over norm."""
    every = np.union1d(told.time, candidate.time)
    times = _between_jumps(every) if np.any(np.diff(told.time) == 0.0) else every
    force = told.force(times)
    difference = np.abs(candidate.force_at(times) - force)
    norms = np.trapezoid(difference**2, times) / np.trapezoid(force**2, times)
    held = difference[times <= told.deepest].max() / force.max()
    return {"held_until_max_depth": float(held), "history": float(np.sqrt(norms))}


def _between_jumps(times: Array) -> Array:
    """The middles of intervals that rounding alone has not made, s: at a jump, a time twice, no two curves agree."""
    lasting = np.diff(times) > ROUNDING * times[-1]
    return np.asarray(0.5 * (times[1:] + times[:-1])[lasting])


def force_bars(told: Told, own: float) -> dict[str, float]:
    """What error bars leave open of :func:`force_errors`; ``own`` is the candidate's, relative to the peak."""
    early = told.force_error(told.time[told.time <= told.deepest]).max() / told.peak
    return {"held_until_max_depth": float(early) + own, "history": told.history_error + own}


def radius_error(told: Told, law: Result) -> float | None:
    """Largest deviation of the contact radius in the rebound, relative to the largest; None without a rebound."""
    time, history = told.time, law.history
    end = RADIUS_UNTIL * min(told.duration, float(history.time[-1]))
    rebound = time[(time >= told.deepest) & (time <= end)]
    if rebound.size == 0:
        return None
    deviation = np.interp(rebound, history.time, history.contact_radius) - told.radius(rebound)
    return float(np.abs(deviation).max() / told.radius(time).max())


def pressure_error(solved: Solved, law: Result) -> float | None:
    """Largest share of the force that a law presses, or pulls, in the wrong place in the rebound; None without any.

    The integral of the deviation's magnitude over the force: the square of a viscous law's pressure, singular at
    the edge, would have no integral. Over rings of the surface, or in plane strain over strips alike.
    """
    pressure = LawPressure.of(law)
    if pressure is None:
        return None
    radii = surface_radii(solved)
    areas = np.ones_like(radii) if law.scene.geometry.shape.plane else radii
    steps = rebound_steps(solved)
    return max((_pressure_deviation(solved, pressure, step, radii, areas) for step in steps), default=None)


def _pressure_deviation(solved: Solved, law: LawPressure, step: int, radii: Array, areas: Array) -> float:
    """Of one step; ``areas``: in any unit, of the pieces of surface around the radii, m."""
    reference = felt(solved.certified, step)
    truth = reference.at(radii)
    deviation = law.at(reference.time, radii) - truth
    return float((areas @ np.abs(deviation)) / (areas @ truth))


def surface_radii(solved: Solved) -> Array:
    """Equally spaced radii over the surface that contact ever reaches, the middles of rings or strips, m."""
    largest = max(snapshot.contact_radius for snapshot in solved.certified.march.snapshots)
    return largest * (np.arange(PRESSURE_POINTS) + 0.5) / PRESSURE_POINTS


def rebound_steps(solved: Solved) -> tuple[int, ...]:
    """Steps of the finest march where the force has fallen to the ``REBOUND_SHARES`` of that at maximum depth.

    None where the march tells no pressure.
    """
    if not solved.certified.march.snapshots:
        return ()
    curve = solved.certified.curve
    rebound = curve.dense_time >= Told.by(solved).deepest
    force = curve.dense_force[rebound]
    fallen = 1 - np.maximum.accumulate(force[::-1])[::-1] / force[0]
    reached = [1 - share for share in REBOUND_SHARES if 1 - share < fallen[-1]]
    times = np.interp(reached, fallen, curve.dense_time[rebound])
    return tuple(nearest_step(solved.certified, float(time)) for time in times)


@dataclass(frozen=True)
class NestedAreas:
    """What the radii show, relative to the largest.

    ``unevenness``: how much the radius falls before its maximum or rises after; ``deviation``: largest difference of
    the radii that Ting pairs; ``bar``: what the error budget leaves open of the difference of two radii.
    """

    unevenness: float
    deviation: float
    bar: float

    @property
    def holds(self) -> bool:
        """Whether nothing beyond the bar speaks against nested areas."""
        return max(self.unevenness, self.deviation) <= self.bar


def nested_areas(scene: Scene, solved: Solved) -> NestedAreas | None:
    """The areas of a certified impact of a scene; None where the contact has no rebound, or an area that stays."""
    curve, modulus = solved.certified.curve, scene.contact_modulus
    time, radius = curve.dense_time, curve.radius_at(curve.dense_time)
    largest = float(radius.max())
    turn = float(time[np.argmax(curve.dense.depth)])
    instants = turn + np.linspace(FIRST, LAST, INSTANTS) * (curve.duration - turn)
    if not curve.separated or scene.target.fixed_radius(scene.geometry.shape) is not None:
        return None
    paired = np.array([_paired(modulus, time, curve.dense_velocity, float(instant)) for instant in instants])
    known = np.isfinite(paired)
    difference = curve.radius_at(instants[known]) - curve.radius_at(paired[known])
    return NestedAreas(
        unevenness=_unevenness(radius) / largest,
        deviation=float(np.abs(difference).max(initial=0.0)) / largest,
        bar=(_bar(solved, instants[known]) + _bar(solved, paired[known])) / largest,
    )


def _paired(modulus: Relaxation, time: Array, velocity: Array, instant: float) -> float:
    """t1 of an instant of the rebound, s; nan where the condition finds none.

    From the instant backwards the integral is negative at first; t1 is where it has come back to zero.
    """
    before = time < instant
    s = np.append(time[before], instant)
    v = np.append(velocity[before], np.interp(instant, time, velocity))
    integrand = modulus(instant - s) * v
    pieces = 0.5 * (integrand[1:] + integrand[:-1]) * np.diff(s)
    from_here = np.append(np.cumsum(pieces[::-1])[::-1], 0.0) + modulus.viscosity * v[-1]
    below = np.flatnonzero(from_here < 0.0)
    first = int(below[0])
    if first == 0:
        return np.nan
    return float(np.interp(0.0, -from_here[first - 1 : first + 1], s[first - 1 : first + 1]))


def _unevenness(radius: Array) -> float:
    """The most that the radius falls on its way up or rises on its way down, m."""
    top = int(radius.argmax())
    up, down = radius[: top + 1], radius[top:]
    falls, rises = np.maximum.accumulate(up) - up, down - np.minimum.accumulate(down)
    return float(max(falls.max(), rises.max()))


def _bar(solved: Solved, time: Array) -> float:
    """Error of a radius at some of these times by every cause, m."""
    changes = [one for several in solved.certified.changes.values() for one in several if isinstance(one, Variation)]
    return float(sum(change.factor * np.abs(change.radius(time)).max() for change in changes))
