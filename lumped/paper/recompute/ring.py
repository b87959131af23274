"""Section 5.2: the polymer of the ring and Fig. 12's impact on it, as far as the text reaches; SI units."""

from __future__ import annotations

import math

from lumped.paper.examples.given import Examples
from lumped.paper.examples.ring_impact import impact, stiffness
from lumped.paper.examples.value import Values, closed

MILLI = 1e3


def springs(examples: Examples) -> Values:
    """E1, E2, Pa, C1, Pa s, and the relaxation time, ms, from E0, R1, R2."""
    ring = examples.ring
    series = ring.E0 * (1.0 + ring.R1)
    return closed(series / ring.R1, series, ring.R2 * series / ring.R1, MILLI * ring.R2 / (1.0 + ring.R1))


def loss_peak(examples: Examples) -> Values:
    """The largest loss tangent, (R1/2)/sqrt(1 + R1), and its frequency, sqrt(1 + R1)/(2 pi R2), Hz."""
    ring = examples.ring
    root = math.sqrt(1.0 + ring.R1)
    return closed(0.5 * ring.R1 / root, root / (2.0 * math.pi * ring.R2))


def relaxed_stiffnesses(examples: Examples) -> Values:
    """(pi/4) l E0/(1 - nu^2), "(29)", N/m, one an assumed nu."""
    return closed(*(stiffness(examples.ring, nu).relaxed for nu in examples.ring.nus))


def impacts(examples: Examples) -> Values:
    """Impact of both masses' reduced mass at the least and the largest assumed nu.

    Restitutions, contact times, ms, and depths over velocity, mm per m/s.
    """
    ring, ptmd = examples.ring, examples.ptmd
    mass = ptmd.m1 * ptmd.m2 / (ptmd.m1 + ptmd.m2)
    found = [impact(stiffness(ring, nu), mass) for nu in (min(ring.nus), max(ring.nus))]
    rows = zip(*((one.restitution, MILLI * one.duration, MILLI * one.depth_per_velocity) for one in found), strict=True)
    return closed(*(number for row in rows for number in row))


MEMBER = {function.__name__: function for function in (springs, loss_peak, relaxed_stiffnesses, impacts)}
