"""Free vibrations of the paper's structure: with the ring, without it, without any damper; each computed once."""

from __future__ import annotations

from functools import cache

from lumped.errors import BadInput, Fault, NotReached
from lumped.paper.examples.given import Ptmd, RingLining
from lumped.paper.examples.ring_impact import stiffness
from lumped.paper.examples.value import Value
from lumped.ptmd import Measures, Oscillator, PoundingDamper, PtmdRing, Start, simulate

# The damper's path is exact to rounding, which some fifty contacts carry on.
ROUNDING = 1e-9
MOST_RESIDUAL = 1e-8  # of the energy at the start
STARTS = ("both", "structure")


@cache
def with_ring(ptmd: Ptmd, lining: RingLining, start: str, nu: float) -> Measures:
    """The pounding damper; `start`: "both" masses or the "structure" alone displaced. Raises BadInput, NotReached."""
    ring = PtmdRing(ptmd.gap, stiffness(lining, nu), 1.0)
    return _measures(ptmd, PoundingDamper(_structure(ptmd), _damper(ptmd), ring), start)


@cache
def without_ring(ptmd: Ptmd, start: str) -> Measures:
    """The damper without pounding."""
    return _measures(ptmd, PoundingDamper(_structure(ptmd), _damper(ptmd)), start)


@cache
def without_damper(ptmd: Ptmd) -> Measures:
    """The structure alone."""
    return _measures(ptmd, PoundingDamper(_structure(ptmd)), "structure")


def measure(measures: Measures, name: str) -> Value:
    """One of the measures, SI. Raises NotReached where it is undefined."""
    number = measures.to_dict()[name]
    if number is None:
        raise NotReached(f"free vibration: {name} is undefined; a longer ptmd.end_time may define it")
    return Value(float(number), ROUNDING * abs(float(number)))


def _measures(ptmd: Ptmd, system: PoundingDamper, start: str) -> Measures:
    if start not in STARTS:
        raise BadInput(Fault("free vibration", "start", f"{start!r}; accepted: {', '.join(STARTS)}"))
    released = Start.both(ptmd.displacement) if start == "both" else Start.structure(ptmd.displacement)
    found = simulate(system, released, ptmd.end_time, ptmd.window)
    if abs(found.energy.residual) > MOST_RESIDUAL * found.energy.initial:
        raise NotReached("free vibration: the energy balance is open; a shorter ptmd.end_time may close it")
    return found.measures


def _structure(ptmd: Ptmd) -> Oscillator:
    return Oscillator(ptmd.m1, ptmd.k1, ptmd.c1)


def _damper(ptmd: Ptmd) -> Oscillator:
    return Oscillator(ptmd.m2, ptmd.k2, ptmd.c2)
