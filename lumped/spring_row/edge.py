"""Where the contact ends and what the springs inside carry: F/2 = int_0^edge f dx, f = held + lift.

`held` is what each spring carries of itself, falling with x; `lift` is common to all and follows from the
motion.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lumped.load_curves import LoadCurve

Array = NDArray[np.float64]


class Growing:
    """The edge stands where the profile meets the surface; there a viscosity alone carries force."""

    def __init__(self, curve: LoadCurve, x: Array, weights: Array, held: Array) -> None:
        self.curve = curve
        self.reach = float(x[-1])
        self.area = float(weights @ held)
        self.last = float(held[-1])

    def __call__(self, lift: float, depth: float, viscous: float) -> tuple[float, float]:
        """F/2 and the edge; the cell beyond the last spring runs from its force to `viscous`."""
        edge: Any = max(self.curve.contact_radius(depth), self.reach)
        beyond = 0.5 * (edge - self.reach) * (self.last + lift + viscous)
        return self.area + lift * self.reach + beyond, edge


class Shrinking:
    """The edge stands where the force of the springs has fallen to zero, between two of them."""

    def __init__(self, x: Array, held: Array) -> None:
        self.x = x
        self.held = held
        self.areas = np.zeros(x.size)
        np.cumsum(0.5 * (x[1:] - x[:-1]) * (held[1:] + held[:-1]), out=self.areas[1:])
        self.order = -held

    def __call__(self, lift: float, depth: float, viscous: float) -> tuple[float, float]:
        """F/2 and the edge; no spring pulls."""
        pressed = int(self.order.searchsorted(lift))
        if pressed == 0:
            return 0.0, 0.0
        i = pressed - 1
        place, force = float(self.x[i]), float(self.held[i]) + lift
        half = float(self.areas[i]) + lift * place
        if pressed == self.x.size:
            return half, place
        width = (float(self.x[pressed]) - place) * force / (force - float(self.held[pressed]) - lift)
        return half + 0.5 * width * force, place + width
