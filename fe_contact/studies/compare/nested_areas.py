"""Whether Ting's solution applies: the contact grows to one maximum and shrinks through the areas it grew through.

His condition pairs every instant t of the rebound with one t1 of the approach (1966, doi:10.1115/1.3625192),

    int_t1^t E*(t - s) d(depth) = 0 ,    contact radius at t = contact radius at t1 .

Motion and radius are those of finite elements; only the modulus is taken from the scene, so that the condition is put
to the test and not used.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget.change import Change
from fe_contact.reference import Solved
from lumped.materials import Relaxation
from lumped.scene.scene import Scene

INSTANTS = 40
# Of the rebound: at its beginning both radii are the largest, at its end they fall like a root.
FIRST, LAST = 0.02, 0.95


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
    changes = [one for several in solved.certified.changes.values() for one in several if isinstance(one, Change)]
    return float(sum(change.factor * np.abs(change.radius(time)).max() for change in changes))
