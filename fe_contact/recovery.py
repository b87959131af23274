"""After separation: the indentation left on the axis of a half-space, and how the surface recovers.

The axis touches the striker from first to last, so its displacement in the contact is the striker's depth, and the
strain y_k of each of its dashpots follows from that alone: y_k' = (depth - y_k)/tau_k. From the separation on nothing
presses; see :class:`lumped.materials.Recovery`. All is linear in the path, and so are the bars: what a varied setting
changes is followed through the recovery.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

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

SHARES = np.linspace(0.0, 1.0, 2001) ** 2  # of the contact: straight between them its path errs by 1e-7 of its depth
ROWS = 25  # look: of the recovery, zero among them
FIRST_GONE, LAST_LEFT = 0.99, 0.01  # of what goes, left at the first and at the last row after separation


def recovers(scene: Scene, curve: Curve) -> bool:
    """Whether the indentation left is known: a half-space that remembers, without waves, from a rigid striker."""
    geometry = scene.geometry
    lone = isinstance(geometry.target, HalfSpace) and not geometry.shape.plane and scene.striker_material is None
    return lone and curve.separated and not scene.model.inertia and not curve.strike.relaxation.is_elastic


def indentation_left(certified: Budget) -> IndentationLeft:
    """Rows from separation to the time when a hundredth of what goes is left, with bars."""
    curve, axes = certified.curve, dict[int, _Axis]()
    axis = _Axis(curve)
    recovery = axis.after(axis.path)
    time = _rows(recovery)
    errors = [_error(change, time, axes) for changes in certified.changes.values() for change in changes]
    reading = axis.left_at_most(_everywhere(curve.end_spread * curve.leaving_speed), time)
    total = np.sum([reading, *errors], axis=0)
    return IndentationLeft(time, recovery(time), total, recovery.permanent, recovery.times)


@dataclass(frozen=True, eq=False)
class _Axis:
    """The axis in the contact of a curve: its path, and what paths over the same times leave."""

    curve: Curve

    @cached_property
    def time(self) -> Array:
        """Times of the contact at which paths are read, s, (n,)."""
        return np.asarray(self.curve.duration * SHARES)

    @cached_property
    def path(self) -> Array:
        """Its own, m, (n,)."""
        return self.curve.read(self.time).depth

    @cached_property
    def _taken(self) -> Array:
        """Share of each rise that a dashpot has taken over by the end: by its own step, by all after it; (k, n-1)."""
        steps, taus = np.diff(self.time), np.array(self.curve.strike.relaxation.times)[:, None]
        ramp, fade = galerkin.weights(np.ones(1), steps / taus)
        return np.asarray(ramp * steps / taus - fade * np.expm1((self.time[1:] - self.time[-1]) / taus))

    def after(self, path: Array) -> Recovery:
        """What a path, m, (n,), leaves: straight between the times, zero at first."""
        return Recovery.of(self.curve.strike.relaxation, float(path[-1]), self._taken @ np.diff(path))

    def left_at_most(self, path: Array, time: Array) -> Array:
        """The most that is left of an error of the path from each time since separation on, (m,), m."""
        return _from_each_on(self.after(path)(time))


def _rows(recovery: Recovery) -> Array:
    """Zero, then times in equal ratios; zero alone where nothing goes."""
    last = recovery.until(LAST_LEFT)
    return np.concatenate([[0.0], np.geomspace(recovery.until(FIRST_GONE), last, ROWS - 1)] if last else [[0.0]])


def _error(change: Variation | Softening | None, time: Array, axes: dict[int, _Axis]) -> Array:
    """Error by one change at times since separation (n,), s, m; ``axes`` by their curves, most of which serve often.

    Of two recoveries the difference may be none by chance, what the path's change leaves with its sign taken away not.
    """
    if change is None:
        return np.full_like(time, np.inf)
    if isinstance(change, Softening):
        return _Axis(change.curve).left_at_most(_everywhere(change.errors["peak_depth"]), time)
    first, second = (axes.setdefault(id(curve), _Axis(curve)) for curve in (change.first, change.second))
    apart = _from_each_on(first.after(first.path)(time) - second.after(second.path)(time))
    trust = change.factor * max(change.weights.values(), default=1.0)
    return np.asarray(trust * np.maximum(apart, first.left_at_most(np.abs(first.path - second.path), time)))


def _from_each_on(values: Array) -> Array:
    """The largest size from each value on."""
    return np.asarray(np.maximum.accumulate(np.abs(values)[::-1])[::-1])


def _everywhere(error: float) -> Array:
    """An error of the path, m, the same all along it."""
    return np.where(SHARES > 0.0, error, 0.0)
