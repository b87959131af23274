"""After separation: the indentation left on the axis of a half-space, and how the surface recovers.

The axis touches the striker from first to last, so its displacement in the contact is the striker's depth, and the
strain y_k of each of its dashpots follows from that alone: y_k' = (depth - y_k)/tau_k. From the separation on nothing
presses; see :class:`lumped.materials.Recovery`. All is linear in the path, and so are the bars: what a varied setting
changes is followed through the recovery.
"""

from __future__ import annotations

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget.budget import Budget
from fe_contact.budget.curve import Curve
from fe_contact.budget.variation import Softening, Variation
from fe_contact.schemes import galerkin
from lumped.materials import Recovery
from lumped.result.result import IndentationLeft
from lumped.scene.scene import Scene
from lumped.targets import HalfSpace

SHARES = np.linspace(0.0, 1.0, 4001) ** 2  # of the contact, at which its path is read
ROWS = 25  # look: of the recovery, zero among them
FIRST_GONE, LAST_LEFT = 0.99, 0.01  # of what goes, left at the first and at the last row after separation


def recovers(scene: Scene, curve: Curve) -> bool:
    """Whether the indentation left is known: a half-space that remembers, without waves, from a rigid striker."""
    geometry = scene.geometry
    lone = isinstance(geometry.target, HalfSpace) and not geometry.shape.plane and scene.striker_material is None
    return lone and curve.separated and not scene.model.inertia and not curve.strike.relaxation.is_elastic


def recovery_of(curve: Curve) -> Recovery:
    """What is left on the axis over the time since separation, m."""
    return _after(curve, curve.read(_times(curve)).depth)


def indentation_left(certified: Budget) -> IndentationLeft:
    """Rows from separation to the time when a hundredth of what goes is left, with bars."""
    curve, recovery = certified.curve, recovery_of(certified.curve)
    time = _rows(recovery)
    errors = [_error(change, time) for changes in certified.changes.values() for change in changes]
    reading = _left_at_most(curve, _everywhere(curve.end_spread * curve.leaving_speed), time)
    total = np.sum([reading, *errors], axis=0)
    return IndentationLeft(time, recovery(time), total, recovery.permanent, recovery.times)


def _rows(recovery: Recovery) -> Array:
    """Zero, then times in equal ratios; zero alone where nothing goes."""
    last = recovery.until(LAST_LEFT)
    return np.concatenate([[0.0], np.geomspace(recovery.until(FIRST_GONE), last, ROWS - 1)] if last else [[0.0]])


def _times(curve: Curve) -> Array:
    """Times of the contact at which the path is read, s, (n,)."""
    return np.asarray(curve.duration * SHARES)


def _after(curve: Curve, path: Array) -> Recovery:
    """What a path of the axis, m, over the times of a contact leaves: straight between them, zero at first."""
    relaxation, time = curve.strike.relaxation, _times(curve)
    taus = np.array(relaxation.times)[:, None]
    ramp, fade = galerkin.weights(np.ones(1), np.diff(time) / taus)
    # share of each rise that a dashpot has taken over by the end, by its own step and by all after it
    taken = ramp * np.diff(time) / taus - fade * np.expm1((time[1:] - time[-1]) / taus)
    return Recovery.of(relaxation, float(path[-1]), taken @ np.diff(path))


def _error(change: Variation | Softening | None, time: Array) -> Array:
    """Error by one change at times since separation (n,), s, m.

    Of two recoveries the difference may be none by chance, what the path's change leaves with its sign taken away not.
    """
    if change is None:
        return np.full_like(time, np.inf)
    if isinstance(change, Softening):
        return _left_at_most(change.curve, _everywhere(change.errors["peak_depth"]), time)
    first, second = change.first, change.second
    one, other = (curve.read(_times(curve)).depth for curve in (first, second))
    apart = _from_each_on(_after(first, one)(time) - _after(second, other)(time))
    trust = change.factor * max(change.weights.values(), default=1.0)
    return np.asarray(trust * np.maximum(apart, _left_at_most(first, np.abs(one - other), time)))


def _left_at_most(curve: Curve, path: Array, time: Array) -> Array:
    """The most that is left of an error of the path from each time since separation on, (n,), m."""
    return _from_each_on(_after(curve, path)(time))


def _from_each_on(values: Array) -> Array:
    """The largest size from each value on."""
    return np.asarray(np.maximum.accumulate(np.abs(values)[::-1])[::-1])


def _everywhere(error: float) -> Array:
    """An error of the path, m, the same all along it."""
    return np.where(SHARES > 0.0, error, 0.0)
