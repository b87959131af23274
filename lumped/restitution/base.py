"""The contract of a damping family: a law's dimensionless damping against its coefficient of restitution."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Protocol

from lumped.errors import BadInput, Fault, NotReached
from lumped.schema.keys import Choice, Kind, Number

EXIT = Choice(("force", "depth"))
RESTITUTION = Number(1e-6, 1.0)
PLASTIC = "; for a plastic impact, e = 0, see lumped.solvers.stereomechanics"
Published = Mapping[str, Callable[[float], float]]
ITERATIONS = 60
# The error after a step is of the order of its square.
LAST_STEP = 1e-9


class Exact(Protocol):
    """An exact relation, one way or the other, for a contact that ends at `exit`."""

    def __call__(self, value: float, exit: str = "force", /) -> float: ...


@dataclass(frozen=True)
class Family:
    """A member of this package. A damping is the law's own dimensionless number, named in its module.

    `restitution` gives the exact e at a damping, which falls from 1 as the damping grows from 0; `damping` that at
    which e is met exactly, for e from 1e-6 to 1. `exit` says where the contact ends: "force", when the force returns
    to zero (no tension), or "depth", when the depth does (tension allowed). `published`: formulas of the literature by
    name, from e to the damping; none knows of an exit. All values are floats; all raise BadInput outside their ranges.
    """

    restitution: Exact
    damping: Exact
    published: Published


@dataclass(frozen=True)
class Limit:
    """The largest damping accepted, and what to say beyond it."""

    highest: float = 1e12
    cure: str = ""


NO_LIMIT: Mapping[str, Limit] = dict.fromkeys(EXIT.options, Limit())


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
