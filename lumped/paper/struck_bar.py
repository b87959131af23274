"""A body with a Hertz contact striking the end of a long bar: the bar answers as a dashpot, and radiates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lumped.errors import NotReached
from lumped.interpolation import highest
from lumped.paper.value import Value
from lumped.rod_waves.tipped import Scales, TippedImpact
from lumped.rod_waves.waves import Waves

RELATIVE = 1e-10
# The bar of the numbers: how far they move when the integrator's tolerance grows a thousand times.
COARSER = 1e3
LONGEST = 1e3  # contact times
PLACES = 401  # in the history, where the peak is looked for


@dataclass(frozen=True)
class StruckBar:
    """Striker of `mass`, kg, and `velocity`, m/s; contact stiffness k, N/m^1.5; bar's impedance Z, N s/m."""

    mass: float
    velocity: float
    k: float
    impedance: float

    def impact(self) -> tuple[Value, Value, Value]:
        """Peak force, N, duration, s, and restitution of the striker. Raises NotReached."""
        fine, coarse = self._numbers(RELATIVE), self._numbers(RELATIVE * COARSER)
        peak, end, e = (Value(a, abs(a - b)) for a, b in zip(fine, coarse, strict=True))
        return peak, end, e

    def _numbers(self, rtol: float) -> tuple[float, float, float]:
        depth = (self.mass * self.velocity**2 / self.k) ** 0.4
        impact = TippedImpact(
            waves=Waves(self.impedance, 0.0, 1.0),
            force=lambda dent: self.k * dent**1.5,
            mass=self.mass,
            velocity=self.velocity,
            gravity=0.0,
            until=LONGEST * depth / self.velocity,
            scales=Scales(depth, depth / self.velocity),
            rtol=rtol,
        )
        _, end, parted = impact.pieces
        if not parted:
            raise NotReached("struck bar: the contact does not end; a stiffer bar or a lighter striker parts")
        _, peak = highest(lambda times: impact.columns(times)[2], np.linspace(0.0, end, PLACES))
        return peak, end, -float(impact.columns(np.array([end]))[1, 0]) / self.velocity
