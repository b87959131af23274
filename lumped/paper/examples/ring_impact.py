"""One impact on the ring's lining as Fig. 12 has it: a mass on the linear 3-parameter spring "(29)" to "(32)".

With the stiffness K(t) = (pi/4) l E*(t), the state (depth, rate, z), z the strained part of the Maxwell branch, is
linear: its matrix exponential is the answer, and the first return of the force to zero ends the contact.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.errors import NotReached
from lumped.materials.networks import sls
from lumped.materials.relaxation import Relaxation
from lumped.paper.examples.given import RingLining

Array = NDArray[np.float64]
SAMPLES = 400


@dataclass(frozen=True)
class RingImpact:
    """Contact time, s, restitution, and depth over velocity at touch, s."""

    duration: float
    restitution: float
    depth_per_velocity: float


def stiffness(ring: RingLining, nu: float) -> Relaxation:
    """K(t), N/m, "(29)"."""
    young = sls.of_ratios(E0=ring.E0, R1=ring.R1, R2=ring.R2)
    return young.scaled(0.25 * math.pi * ring.width / (1.0 - nu**2))


def impact(spring: Relaxation, mass: float) -> RingImpact:
    """The impact of a mass, kg, on K(t) with one relaxation time. Raises NotReached when the bodies do not part."""
    (branch,), (tau,) = spring.moduli, spring.times
    row = np.array([spring.equilibrium, 0.0, branch])
    matrix = np.array([[0.0, 1.0, 0.0], -row / mass, [0.0, 1.0, -1.0 / tau]])
    values, vectors = np.linalg.eig(matrix)
    weights = np.linalg.solve(vectors, np.array([0.0, 1.0, 0.0], dtype=complex))

    def state(time: float) -> Array:
        return np.asarray((vectors @ (weights * np.exp(values * time))).real)

    end = _first_fall(lambda time: float(row @ state(time)), 2.0 * math.pi * math.sqrt(mass / spring.equilibrium))
    turn = _first_fall(lambda time: float(state(time)[1]), end)
    return RingImpact(end, -float(state(end)[1]), float(state(turn)[0]))


def _first_fall(function: Callable[[float], float], last: float) -> float:
    """The first time after the start, up to `last`, s, at which a function falls through zero."""
    from scipy.optimize import brentq

    times = np.linspace(0.0, last, SAMPLES)[1:]
    below = [function(time) <= 0.0 for time in times]
    if not any(below[1:]):
        raise NotReached(f"ring impact: no separation within {last:.3g} s; a stiffer ring or a lighter mass parts")
    i = below.index(True)
    return float(brentq(function, times[i - 1], times[i], xtol=1e-16, rtol=1e-14))
