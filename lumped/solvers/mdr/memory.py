"""How the branches of a relaxation series fade while the depth grows evenly: integrals over time, in closed form."""

from __future__ import annotations

import math
from typing import NamedTuple

from lumped.materials import Relaxation

SERIES_BELOW = 0.5
# 2 (-1)^j/(j+3)!
C0, C1, C2, C3, C4, C5, C6, C7, C8, C9, C10, C11 = (2.0 * (-1.0) ** j / math.factorial(j + 3) for j in range(12))


class Fading(NamedTuple):
    """Of one branch over a time h, with u the time left of it and e = exp(-u/tau).

    `left` = exp(-h/tau), `filled` = int e du, `grown` = int e (h-u) du, `bent` = int e (h-u)^2/h du, and `spilled` =
    tau int (1-e)^2 du.
    """

    left: float
    filled: float
    grown: float
    bent: float
    spilled: float


def fading(tau: float, h: float) -> Fading:
    """The integrals, to full relative precision from h << tau to h >> tau."""
    x = h / tau
    if x < SERIES_BELOW:
        second = C6 + x * (C7 + x * (C8 + x * (C9 + x * (C10 + x * C11))))
        second = C0 + x * (C1 + x * (C2 + x * (C3 + x * (C4 + x * (C5 + x * second)))))
        first = 0.5 * (1.0 - x * second)
        zeroth = 1.0 - x * first
        third = first - 0.5 * second - 0.5 * x * first * first
        return Fading(1.0 - x * zeroth, h * zeroth, h * h * first, h * h * second, h * h * x * third)
    left = math.exp(-x)
    gone = 1.0 - left
    grown = x - gone
    bent, spilled = x - 2.0 * grown / x, grown - 0.5 * gone * gone
    return Fading(left, tau * gone, tau * tau * grown, tau * tau * bent, tau * tau * spilled)


def fadings(modulus: Relaxation, h: float) -> list[Fading]:
    """Those of every branch."""
    return [fading(tau, h) for tau in modulus.times]
