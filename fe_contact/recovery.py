"""After separation: the indentation left on the axis of a half-space, and how the surface recovers.

The axis touches the striker from first to last, so its displacement in the contact is the striker's depth, and the
strain y_k of each of its dashpots follows from that alone: y_k' = (depth - y_k)/tau_k. From the separation on nothing
presses; see :class:`lumped.materials.Recovery`. All is linear in the path, and so are the bars: what a varied setting
changes is followed through the recovery.
"""

from __future__ import annotations

import numpy as np

from fe_contact.certify import Budget
from fe_contact.change import Change
from fe_contact.curve import Curve
from fe_contact.forms import Array
from fe_contact.softening import Softening
from lumped.indentation_left import IndentationLeft
from lumped.materials import Recovery
from lumped.scene import Scene
from lumped.targets import HalfSpace

SAMPLES = 4001  # of the path, between which the depth counts as linear
ROWS = 25
FIRST_GONE, LAST_LEFT = 0.99, 0.01  # of what goes, left at the first and at the last row after separation


def recovers(scene: Scene, curve: Curve) -> bool:
    """Whether the indentation left is known: a half-space that remembers, without waves, from a rigid striker."""
    geometry = scene.geometry
    lone = isinstance(geometry.target, HalfSpace) and not geometry.shape.plane and scene.striker_material is None
    return lone and curve.separated and not scene.model.inertia and not curve.strike.relaxation.is_elastic


def recovery_of(curve: Curve) -> Recovery:
    """What is left on the axis over the time since separation, m."""
    time = curve.duration * np.linspace(0.0, 1.0, SAMPLES) ** 2
    depth = curve.read(time).depth
    taus = np.array(curve.strike.relaxation.times)[:, None]
    lengths, rises = np.diff(time), np.diff(depth)
    sprung = -rises * np.expm1(-lengths / taus) * (taus / lengths) * np.exp((time[1:] - time[-1]) / taus)
    return Recovery.of(curve.strike.relaxation, float(depth[-1]), depth[-1] - sprung.sum(axis=1))


def indentation_left(certified: Budget) -> IndentationLeft:
    """Rows from separation to the time when a hundredth of what goes is left, with bars."""
    recovery = recovery_of(certified.curve)
    time = _rows(recovery)
    depth = recovery(time)
    left = depth / depth[0]
    curve = certified.curve
    errors = [_error(change, time, left) for changes in certified.changes.values() for change in changes]
    reading = curve.end_spread * curve.leaving_speed * left
    return IndentationLeft(time, depth, np.sum([reading, *errors], axis=0), recovery.permanent, recovery.times)


def _rows(recovery: Recovery) -> Array:
    """Zero, then times in equal ratios; zero alone where nothing goes."""
    last = recovery.until(LAST_LEFT)
    return np.concatenate([[0.0], np.geomspace(recovery.until(FIRST_GONE), last, ROWS - 1)] if last else [[0.0]])


def _error(change: Change | Softening | None, time: Array, left: Array) -> Array:
    """Error by one change at times (n,), s, m; ``left`` (n,): share of the depth that is left by then.

    The largest from each time on, and at least what the path changes late in the contact: a difference of two
    recoveries may cross zero anywhere.
    """
    if change is None:
        return np.full_like(time, np.inf)
    if isinstance(change, Softening):
        return change.errors["peak_depth"] * left
    apart = np.abs(recovery_of(change.first)(time) - recovery_of(change.second)(time))
    onwards = np.maximum.accumulate(apart[::-1])[::-1]
    trust = change.factor * max(change.weights.values(), default=1.0)
    return np.asarray(trust * np.maximum(onwards, change.late_depth * left))
