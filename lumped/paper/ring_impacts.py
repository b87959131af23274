"""The ring of section 5.2: one impact on its lining as Fig. 12 has it, and vibrations with a damper that pounds on it.

The impact is that of a mass on the linear 3-parameter spring "(29)" to "(32)". With the stiffness
K(t) = (pi/4) l E*(t), the state (depth, rate, z), z the strained part of the Maxwell branch, is linear: its matrix
exponential is the answer, and the first return of the force to zero ends the contact.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import cache

import numpy as np

from lumped.errors import BadInput, Fault, NotReached
from lumped.materials.networks import sls
from lumped.materials.relaxation import Relaxation
from lumped.numbers import Array
from lumped.paper.given import Examples, Ptmd, RingLining
from lumped.paper.value import MILLI, Value
from lumped.ptmd import Measures, Oscillator, PoundingDamper, PtmdRing, Start, simulate

SAMPLES = 400  # work: times among which the first separation is looked for
# The damper's path is exact to rounding, which some fifty contacts carry on.
ROUNDING = 1e-9
MOST_RESIDUAL = 1e-8  # of the energy at the start
STARTS = ("both", "structure")


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
    state, row = _motion(spring, mass), _row(spring)
    end = _first_fall(lambda time: float(row @ state(time)), 2.0 * math.pi * math.sqrt(mass / spring.equilibrium))
    turn = _first_fall(lambda time: float(state(time)[1]), end)
    return RingImpact(end, -float(state(end)[1]), float(state(turn)[0]))


def force(spring: Relaxation, mass: float, times: Array) -> Array:
    """Of this impact at times (n,), s, in contact: over the velocity at touch, N s/m."""
    state = _motion(spring, mass)
    return np.array([_row(spring) @ state(time) for time in times.tolist()])


def _row(spring: Relaxation) -> Array:
    """The force of a state, N/m."""
    return np.array([spring.equilibrium, 0.0, spring.moduli[0]])


def _motion(spring: Relaxation, mass: float) -> Callable[[float], Array]:
    """The state a time, s, after a touch at 1 m/s."""
    matrix = np.array([[0.0, 1.0, 0.0], -_row(spring) / mass, [0.0, 1.0, -1.0 / spring.times[0]]])
    values, vectors = np.linalg.eig(matrix)
    weights = np.linalg.solve(vectors, np.array([0.0, 1.0, 0.0], dtype=complex))
    return lambda time: np.asarray((vectors @ (weights * np.exp(values * time))).real)


def _first_fall(function: Callable[[float], float], last: float) -> float:
    """The first time after the start, up to `last`, s, at which a function falls through zero."""
    from scipy.optimize import brentq

    times = np.linspace(0.0, last, SAMPLES)[1:]
    below = [function(time) <= 0.0 for time in times]
    if not any(below[1:]):
        raise NotReached(f"ring impact: no separation within {last:.3g} s; a stiffer ring or a lighter mass parts")
    i = below.index(True)
    return float(brentq(function, times[i - 1], times[i], xtol=1e-16, rtol=1e-14))


@cache
def measures(ptmd: Ptmd, start: str, lining: RingLining | None, damped: bool = True) -> Measures:
    """What the pounding damper does to its structure.

    `start`: "both" masses or the "structure" alone displaced; `lining`: None, a damper that meets no ring; `damped`:
    False, a structure without a damper. Raises BadInput, NotReached.
    """
    if start not in STARTS:
        raise BadInput(Fault("free vibration", "start", f"{start!r}; accepted: {', '.join(STARTS)}"))
    damper = Oscillator(ptmd.m2, ptmd.k2, ptmd.c2) if damped else None
    ring = PtmdRing(ptmd.gap, stiffness(lining, lining.nu), 1.0) if lining else None
    system = PoundingDamper(Oscillator(ptmd.m1, ptmd.k1, ptmd.c1), damper, ring)
    released = Start.both(ptmd.displacement) if start == "both" else Start.structure(ptmd.displacement)
    found = simulate(system, released, ptmd.end_time, ptmd.window)
    if abs(found.energy.residual) > MOST_RESIDUAL * found.energy.initial:
        raise NotReached("free vibration: the energy balance is open; a shorter ptmd.end_time may close it")
    return found.measures


def measure(found: Measures, name: str) -> Value:
    """One of the measures, SI. Raises NotReached where it is undefined."""
    number = asdict(found)[name]
    if number is None:
        raise NotReached(f"free vibration: {name} is undefined; a longer ptmd.end_time may define it")
    return Value(float(number), ROUNDING * abs(float(number)))


def frequency(stiffness: float, mass: float) -> float:
    """In Hz."""
    return math.sqrt(stiffness / mass) / (2.0 * math.pi)


def mass_in_dashpot(p: Ptmd) -> float:
    """The m2, kg, which the printed c2 and k2 hold."""
    return (p.c2 / (2.0 * p.damping_ratio)) ** 2 / p.k2


def pounding(e: Examples, name: str, start: str = "both") -> Value:
    """A measure with the pounding damper."""
    return measure(measures(e.ptmd, start, e.ring), name)


def plain(e: Examples, name: str) -> Value:
    """A measure with the damper and without its ring."""
    return measure(measures(e.ptmd, "both", None), name)


def alone(e: Examples, name: str) -> Value:
    """A measure of the structure without a damper."""
    return measure(measures(e.ptmd, "structure", None, damped=False), name)


def decay(e: Examples, vibration: Callable[[Examples, str], Value]) -> list[Value]:
    """t50 and t10, s, RMS displacement, mm, of a vibration: `pounding` or `alone`."""
    return [vibration(e, "t50"), vibration(e, "t10"), vibration(e, "rms_displacement") * MILLI]


def impacts(e: Examples) -> list[float]:
    """Of both masses' reduced mass at the least and the largest assumed nu.

    Restitutions, contact times, ms, and depths over velocity, mm per m/s.
    """
    mass = e.ptmd.m1 * e.ptmd.m2 / (e.ptmd.m1 + e.ptmd.m2)
    found = [impact(stiffness(e.ring, nu), mass) for nu in (min(e.ring.nus), max(e.ring.nus))]
    times = [MILLI * one.duration for one in found]
    return [*(one.restitution for one in found), *times, *(MILLI * one.depth_per_velocity for one in found)]
