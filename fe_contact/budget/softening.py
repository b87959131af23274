"""The error of a body that is a little too soft or too stiff everywhere alike, without a march.

On a mesh that follows the contact the far field lifts or lowers the whole contact of an elastic body by the same
share of its displacement, whatever the instant. That is a modulus which errs by this share: on the same path the force
errs by no more than it, hence so does the impulse, and with it speed and path.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget.curve import Curve
from fe_contact.steppers.struck import Deformable


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
