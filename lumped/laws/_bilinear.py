"""The numbers of the bilinear impact material, from an elastic stiffness and a restitution.

The published recipe asks for the loss E = k d^(alpha + 1) (1 - e^2)/(alpha + 1) at the largest depth d, with the
secant stiffness K = k d^(alpha - 1) there and a yield depth a d:
    k1 = K + E/(a d^2),  k2 = K - E/((1 - a) d^2).
Muthukumar and DesRoches 2006, doi 10.1002/eqe.557; d is that of the elastic impact. But the loop stores other energy
than the elastic spring, so that neither d nor e come out. Exact, E = (1 - e^2) m v^2/2 and d is the depth reached,
    K d^2 = (1 + e^2) m v^2/2, as the work done up to d is (K d^2 + E)/2.
"""

from __future__ import annotations

from typing import NamedTuple

from lumped.solvers.point.bodies import Bodies

YIELD_SHARE = 0.1


class LoopNumbers(NamedTuple):
    """k1 and k2, N/m, and the yield depth, m."""

    k1: float
    k2: float
    yield_depth: float


def exact(k: float, alpha: float, bodies: Bodies, e: float) -> LoopNumbers:
    """The loop that meets e and has the elastic law's force at its largest depth.

    k2 stays positive where a < 2 e^2/(1 + e^2): for e below 1/3 a is half of that.
    """
    kinetic = 0.5 * bodies.mass * bodies.velocity**2
    depth = ((1.0 + e**2) * kinetic / k) ** (1.0 / (alpha + 1.0))
    share = min(YIELD_SHARE, e**2 / (1.0 + e**2))
    return recipe(k * depth ** (alpha - 1.0), depth, (1.0 - e) * (1.0 + e) * kinetic, share)


def published(k: float, alpha: float, bodies: Bodies, e: float) -> LoopNumbers:
    """The recipe at the depth of the elastic impact."""
    kinetic = 0.5 * bodies.mass * bodies.velocity**2
    depth = ((alpha + 1.0) * kinetic / k) ** (1.0 / (alpha + 1.0))
    return recipe(k * depth ** (alpha - 1.0), depth, (1.0 - e) * (1.0 + e) * kinetic, YIELD_SHARE)


def recipe(stiffness: float, depth: float, loss: float, share: float) -> LoopNumbers:
    """From the secant stiffness, N/m, at a depth, m, the loss, J, and the yield depth's share of the depth."""
    k1, k2 = stiffness + loss / (share * depth**2), stiffness - loss / ((1.0 - share) * depth**2)
    return LoopNumbers(k1, k2, share * depth)
