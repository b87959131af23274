"""How far a candidate's force, contact radius and pressure are from the finite-element reference over time."""

from __future__ import annotations

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.reference import Solved
from fe_contact.results.surface_pressure import felt, nearest_step
from fe_contact.studies.compare.law_pressure import LawPressure
from fe_contact.studies.compare.told import Told
from lumped.result.history import History
from lumped.result.result import Result
from lumped.result.score import Curve as Measured

REBOUND_SHARES = (0.75, 0.5, 0.25)  # of the force at maximum depth: instants at which pressures are compared
RADIUS_UNTIL = 0.95  # of the shorter contact: later the radius falls like a root and shows the duration again
PRESSURE_POINTS = 240
ROUNDING = 1e-9  # of the contact, by which the times of one jump may differ


def force_errors(told: Told, candidate: History | Measured) -> dict[str, float | None]:
    """``held_until_max_depth`` relative to the reference's peak; ``history``, norm over norm."""
    times = (
        _between_jumps(np.union1d(told.time, candidate.time)) if told.jumps else np.union1d(told.time, candidate.time)
    )
    force = told.force(times)
    difference = np.abs(candidate.force_at(times) - force)
    norms = np.trapezoid(difference**2, times) / np.trapezoid(force**2, times)
    held = difference[times <= told.deepest].max() / force.max()
    return {"held_until_max_depth": float(held), "history": float(np.sqrt(norms))}


def _between_jumps(times: Array) -> Array:
    """The middles of intervals that rounding alone has not made, s: at a jump itself no two curves agree."""
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
