"""Sections 2 to 4: what the paper says of contact laws, strain rates and its measure of error."""

from __future__ import annotations

import math

from lumped.paper.examples.given import Examples
from lumped.paper.examples.steel_impacts import hertz
from lumped.paper.examples.value import Value, Values, closed, read
from lumped.result.score import POINTS

# Profiles c r^n on a half-space: flat punch, parabola, cone.
PROFILES = (math.inf, 2.0, 1.0)
# Tabor's representative strain is 0.2 a/R; while a grows as sqrt(R depth) its rate is of the order 0.4 v/a.
STRAIN_RATE = 0.4


def exponents(examples: Examples) -> Values:
    """alpha = 1 + 1/n of a profile c r^n, Sneddon 1965, doi 10.1016/0020-7225(65)90019-4."""
    return tuple(Value(1.0 + 1.0 / n) for n in PROFILES)


def strain_rate(examples: Examples) -> Values:
    """0.4 v/a at the elastic peak of the steel ball, 1/s."""
    steel = examples.steel
    depth = read(hertz(steel, steel.contact_modulus), "peak_depth")
    rate = STRAIN_RATE * steel.velocity / math.sqrt(steel.radius * depth.value)
    return (Value(rate, 0.5 * rate * depth.error / depth.value),)


def intervals(examples: Examples) -> Values:
    """Equal intervals between the points of "(21)"."""
    return closed(POINTS - 1)


MEMBER = {"exponents": exponents, "strain_rate": strain_rate, "intervals": intervals}
