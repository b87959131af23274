"""A body with a Hertz contact striking the end of a long bar: the bar answers as a dashpot, and radiates.

St Venant's one-dimensional waves: the struck end moves at F/Z until an echo returns, Z = density c A.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.errors import NotReached
from lumped.paper.value import Value

Array = NDArray[np.float64]
RELATIVE, ABSOLUTE = 1e-10, 1e-12
# The bar of the numbers: how far they move when the integrator's tolerance grows a thousand times.
COARSER = 1e3
LONGEST = 1e3  # contact times


@dataclass(frozen=True)
class StruckBar:
    """Striker of `mass`, kg, and `velocity`, m/s; contact stiffness k, N/m^1.5; bar's impedance Z, N s/m."""

    mass: float
    velocity: float
    k: float
    impedance: float

    def impact(self) -> tuple[Value, Value, Value]:
        """Peak force, N, duration, s, and restitution of the striker. Raises NotReached."""
        depth = (self.mass * self.velocity**2 / self.k) ** 0.4
        force, time = self.k * depth**1.5, depth / self.velocity
        loss = force / (self.impedance * self.velocity)
        fine, coarse = _dimensionless(loss, 1.0), _dimensionless(loss, COARSER)
        peak, end, e = (Value(a, abs(a - b)) for a, b in zip(fine, coarse, strict=True))
        return peak.times(force), end.times(time), e


def _dimensionless(loss: float, looser: float) -> tuple[float, float, float]:
    """Peak, end and restitution of x'' = -d^1.5, d' = x' - loss d^1.5, x'(0) = 1."""
    from scipy.integrate import solve_ivp

    def rates(_: float, y: Array) -> list[float]:
        pressed = max(y[0], 0.0) ** 1.5
        return [y[1] - loss * pressed, -pressed]

    def parted(_: float, y: Array) -> float:
        return float(y[0])

    def turned(_: float, y: Array) -> float:
        return rates(0.0, y)[0]

    parted.terminal, parted.direction = True, -1.0  # type: ignore[attr-defined]
    span, start, rtol, atol = (0.0, LONGEST), [0.0, 1.0], RELATIVE * looser, ABSOLUTE * looser
    solved = solve_ivp(rates, span, start, "DOP853", events=(parted, turned), rtol=rtol, atol=atol)
    states = solved.y_events
    if states is None or solved.status != 1 or not len(states[1]):
        raise NotReached("struck bar: the contact does not end; a stiffer bar or a lighter striker parts")
    deepest, last = states[1][0], states[0][-1]
    return float(deepest[0]) ** 1.5, float(solved.t[-1]), -float(last[1])


def bar_impedance(modulus: float, density: float, area: float) -> float:
    """density c A = A sqrt(E density), N s/m; Pa, kg/m3, m2."""
    return area * math.sqrt(modulus * density)
