"""What a comparison reads off a reference, whether its steps are still at hand or its history alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.reference import Solved
from lumped.result.result import Result

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
    def jumps(self) -> bool:
        """Whether the force has two values at some time."""
        return bool(np.any(np.diff(self.time) == 0.0))

    @property
    def deepest(self) -> float:
        """Time of the maximum depth, s."""
        return float(self.time[np.argmax(self.depth)])
