"""Damping against the coefficient of restitution, what the laws that take e share.

Most of them are the damped linear oscillator x'' + 2 zeta x' + x = 0 that starts at x = 0 with x' = 1. It turns when
arccos(zeta)/sqrt(1-zeta^2) has passed, its force 2 zeta x' + x is zero after twice that time, and x itself after
pi/sqrt(1-zeta^2). Overdamped, arccosh(zeta)/sqrt(zeta^2-1) takes the place of the first, and x never returns to zero.
A decay is -ln of an amplitude, and is zeta times the time in all three cases.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Protocol

from lumped.errors import BadInput, Fault, NotReached, nearest
from lumped.schema.keys import Choice, Kind, Number

EXACT = "exact"
EXIT = Choice(("force", "depth"))
RESTITUTION = Number(1e-6, 1.0)
PLASTIC = "; for a plastic impact, e = 0, see lumped.solvers.stereomechanics"
Published = Mapping[str, Callable[[float], float]]
ITERATIONS = 60  # work: of the root search, more is no convergence
# The error after a step is of the order of its square.
LAST_STEP = 1e-9


class Exact(Protocol):
    """An exact relation, one way or the other, for a contact that ends at `exit`."""

    def __call__(self, value: float, exit: str = "force", /) -> float: ...


@dataclass(frozen=True)
class Family:
    """What a law tells of its damping, a dimensionless number named in its module.

    `restitution` gives the exact e at a damping, which falls from 1 as the damping grows from 0; `damping` that at
    which e is met exactly, for e from 1e-6 to 1. `exit` says where the contact ends: "force", when the force returns
    to zero (no tension), or "depth", when the depth does (tension allowed). `published`: formulas of the literature by
    name, from e to the damping; none knows of an exit. All values are floats; all raise BadInput outside their ranges.
    """

    restitution: Exact
    damping: Exact
    published: Published


def damping(family: Family, e: float, exit: str = "force", formula: str = EXACT) -> float:
    """The family's damping for e: exact at this exit, or by a published formula, which knows of no exit.

    Raises BadInput, for an unknown formula with the nearest name.
    """
    if formula == EXACT:
        return family.damping(e, exit)
    names = (EXACT, *family.published)
    if formula not in names:
        message = f"{formula!r} is not known; accepted: {', '.join(names)}{nearest(formula, names)}"
        raise BadInput(Fault("restitution", "formula", message))
    return family.published[formula](e)


@dataclass(frozen=True)
class Limit:
    """The largest damping accepted, and what to say beyond it."""

    highest: float = 1e12
    cure: str = ""


NO_LIMIT: Mapping[str, Limit] = dict.fromkeys(EXIT.options, Limit())
# The speed at zero x is below 1e-96 at this damping ratio.
UNDERDAMPED = 0.9999
NEVER_BACK = '; from critical damping on the depth never returns to zero: ask for exit = "force"'
NEAR_CRITICAL = 1e-8  # rounding: of the damping ratio about 1, where the quotient would be 0/0 and its limit stands


def check_damping(value: float, exit: str, limits: Mapping[str, Limit] = NO_LIMIT) -> float:
    """The damping, accepted from 0 to the limit of the exit; raises BadInput."""
    check("exit", exit, EXIT)
    limit = limits[exit]
    check("damping", value, Number(0.0, limit.highest), limit.cure)
    return float(value)


def check_restitution(e: float, exit: str = "force") -> float:
    """e, accepted from 1e-6 to 1; raises BadInput."""
    check("exit", exit, EXIT)
    check("e", e, RESTITUTION, PLASTIC)
    return float(e)


def decay_of(e: float, exit: str) -> float:
    """-ln e, checked as `check_restitution` does."""
    return abs(math.log(check_restitution(e, exit)))


def formulas(**named: Callable[[float], float]) -> Published:
    """Published formulas by name, each made to check its e."""
    return MappingProxyType({name: _checked(formula) for name, formula in named.items()})


def check(name: str, value: object, kind: Kind, cure: str = "") -> None:
    """Raises BadInput, with the name, the range and the cure, for a value which `kind` refuses."""
    try:
        kind.read(value)
    except ValueError:
        message = f"{value!r} is not accepted; accepted: {kind.accepted}{cure}"
        raise BadInput(Fault("restitution", name, message)) from None


def _checked(formula: Callable[[float], float]) -> Callable[[float], float]:
    return lambda e: formula(check_restitution(e))


def newton(value_and_slope: Callable[[float], tuple[float, float]], start: float) -> float:
    """The positive root of a function given with its slope, to rounding. Raises NotReached."""
    x = start
    for _ in range(ITERATIONS):
        value, slope = value_and_slope(x)
        step = value / slope
        x -= step
        if abs(step) <= LAST_STEP * abs(x):
            return x
    raise NotReached(f"no root was found in {ITERATIONS} iterations from {start:g}")


def oscillator(unit: float, rebounds: bool, **published: Callable[[float], float]) -> Family:
    """The family of a law that is the oscillator, in a variable of its own, with the damping ratio damping/unit.

    `rebounds`: whether it is damped in the rebound too. If not, it leaves with what the spring holds at the turn, the
    force ends with the depth, and both exits are one.
    """
    limits = {"force": Limit(), "depth": Limit(unit * UNDERDAMPED, NEVER_BACK)} if rebounds else NO_LIMIT

    def restitution(damping: float, exit: str = "force") -> float:
        zeta = check_damping(damping, exit, limits) / unit
        return math.exp(-(decay(zeta, exit) if rebounds else decay_to_turn(zeta)))

    def damping(e: float, exit: str = "force") -> float:
        lost = decay_of(e, exit)
        return unit * (zeta_of_decay(lost, exit) if rebounds else zeta_of_decay_to_turn(lost))

    return Family(restitution, damping, formulas(**published))


def decay(zeta: float, exit: str) -> float:
    """-ln of the speed where the force is zero, or the depth x."""
    if exit == "force":
        return 2.0 * decay_to_turn(zeta)
    return math.pi * zeta / math.sqrt((1.0 - zeta) * (1.0 + zeta))


def zeta_of_decay(decay: float, exit: str) -> float:
    """The inverse of `decay`; at exit "depth" that is "(7)". Raises NotReached."""
    if exit == "force":
        return zeta_of_decay_to_turn(0.5 * decay)
    return decay / math.hypot(math.pi, decay)


def decay_to_turn(zeta: float) -> float:
    """-ln of the largest x."""
    return zeta * turning_time(zeta)


def zeta_of_decay_to_turn(decay: float) -> float:
    """The inverse of `decay_to_turn`. Raises NotReached."""
    if decay == 0.0:
        return 0.0

    def value_and_slope(zeta: float) -> tuple[float, float]:
        return decay_to_turn(zeta) - decay, _slope(zeta)

    return newton(value_and_slope, math.sinh(decay))


def turning_time(zeta: float) -> float:
    """arccos(zeta)/sqrt(1-zeta^2), arccosh above 1: falls from pi/2 at zeta = 0 through 1 at zeta = 1."""
    if zeta == 1.0:
        return 1.0
    reach = math.sqrt(abs(1.0 - zeta) * (1.0 + zeta))
    return (math.acos(zeta) if zeta < 1.0 else math.acosh(zeta)) / reach


def _slope(zeta: float) -> float:
    """d decay_to_turn/d zeta = (turning time - zeta)/(1 - zeta^2), 2/3 at zeta = 1."""
    if abs(1.0 - zeta) < NEAR_CRITICAL:
        return 2.0 / 3.0
    return (turning_time(zeta) - zeta) / ((1.0 - zeta) * (1.0 + zeta))
