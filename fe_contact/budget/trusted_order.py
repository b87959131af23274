"""Orders to trust after Richardson's extrapolation, one more than the scheme's own where nothing speaks against it.

What adds up over the contact loses an order to any relaxation. A dashpot's force is one of velocities, and so is that
of a branch which relaxes within two steps: its extrapolated error falls no faster than the scheme's. All forces lose as
much of an order as such ones have in all that presses, and so does what adds up.

A relaxation about as long as a step gives the scheme's order one coefficient for longer steps and another for
shorter ones, so that extrapolation gains no order. By chance it may even agree with itself where it is wrong: of what
the steps change before it, the share that such branches carry is kept as an error too.

The force of a viscous contact has a kink where its edge turns, anywhere in a step: that leaves an error of order two
with a coefficient of its own for every length of step. What a scheme of order one gains by extrapolation is lost in it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fe_contact.budget.change import Change
from fe_contact.budget.curve import Curve

AS_EXPECTED = (0.8, 1.35)  # shares of the expected ratio of changes that show the order, 1.7 to 2.4 where it is two
ABOUT = (0.6, 2.5)  # the same that show it about: extrapolation gains no order that could be relied on
ASYMPTOTIC = 1e-2  # share of the duration by which the fewest steps may err where orders are to be believed
NEARLY = 0.8  # share of the expected ratio that the durations must show: they stand for themselves alone
ABOUT_A_STEP = (0.4, 9.0)  # step over relaxation time: outside, its weight in the step is within 1/8 of a power of it


@dataclass(frozen=True)
class Trust:
    """Orders of the extrapolated force and of the quantities that deserve less trust; ``kept``: share of the finest
    steps' own change that extrapolation may leave.
    """

    orders: dict[str, float]
    kept: float


def trust(curves: tuple[Curve, Curve, Curve], order: int, steps: tuple[float, float], flat: bool) -> Trust:
    """What three runs show, and what the relaxation lets be expected.

    Parameters
    ----------
    curves : with steps in the ratio 4 : 2 : 1.
    order : the scheme's own.
    steps : the shortest and the longest that count, s.
    flat : whether the area presses at once, so that all steps feel a relaxation, else the few that are as long.
    """
    relaxation = curves[0].strike.relaxation
    force: float = _trusted_order(*curves, order)
    if order == 1 and not flat and not relaxation.is_elastic:
        force = order
    duration = _order_of_duration(*curves, order)
    shortest, longest = np.divide.outer(steps, relaxation.times)
    within_step = bool(np.any((longest > ABOUT_A_STEP[0]) & (shortest < ABOUT_A_STEP[1])))
    fast, dashpots = _shares(curves[0], 2.0 * longest > ABOUT_A_STEP[0])
    if within_step:
        summed = order - dashpots if force > order else 1
        force = 1 if flat else min(force, order)
    else:
        summed = force if relaxation.is_elastic else min(force, order - dashpots - fast)
    force = min(force, order + 1 - dashpots - fast)
    orders = {"impulse": summed, "restitution": summed, "peak_depth": summed, "duration": min(force, duration)}
    return Trust({"force": force} | orders, fast if within_step else 0.0)


def _trusted_order(fine: Curve, half: Curve, quarter: Curve, order: int) -> int:
    """Order left after extrapolation: one more than the scheme's if three step lengths show the scheme's own.

    The velocity is asked, since the force of a viscous contact may jitter by more than the steps change it. Where two
    orders cancel each other its changes may differ in sign.
    """
    least = Change(fine, half, 1.0).signed_velocity or np.finfo(float).tiny
    seen = Change(half, quarter, 1.0).signed_velocity / least
    share = seen / 2**order
    if AS_EXPECTED[0] <= share <= AS_EXPECTED[1]:
        return order + 1
    return order if ABOUT[0] <= share <= ABOUT[1] else 1


def _order_of_duration(fine: Curve, half: Curve, quarter: Curve, order: int) -> int:
    """Order to trust of the duration: where the fewest steps err by more than a per cent, only what it shows."""
    first, second, third = (curve.quantities["duration"] for curve in (fine, half, quarter))
    if first is None or second is None or third is None or abs(third - second) <= ASYMPTOTIC * first:
        return order + 1
    return order if abs(third - second) >= NEARLY * 2**order * abs(second - first) else 1


def _shares(curve: Curve, fast: npt.NDArray[np.bool_]) -> tuple[float, float]:
    """Shares of the force, each over the contact, that ``fast`` branches (k,) carry, and that dashpots do."""
    relaxation = curve.strike.relaxation
    moduli, times = np.array(relaxation.moduli), np.array(relaxation.times)
    viscous = np.array([float(moduli[fast] @ times[fast]), relaxation.viscosity])
    elastic = (relaxation.equilibrium + float(moduli[~fast].sum())) * curve.duration
    first, second = viscous / (viscous.sum() + elastic) if viscous.any() else viscous
    return float(first), float(second)
