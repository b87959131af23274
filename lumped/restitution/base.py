"""The contract of a damping family: a law's dimensionless damping against its coefficient of restitution."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Protocol

from lumped.errors import BadInput, Fault
from lumped.schema.keys import Choice, Key, Number

EXIT = Choice(("force", "depth"))
RESTITUTION = Number(1e-6, 1.0)
PLASTIC = "; for a plastic impact, e = 0, see lumped.solvers.stereomechanics"

Published = Mapping[str, Callable[[float], float]]


class Family(Protocol):
    """What a module of this package offers. A damping is the law's own dimensionless number, named in its module.

    `exit` says where the contact ends: "force", when the force returns to zero (no tension), or "depth", when the
    depth does (tension allowed). All values are floats; all raise BadInput outside their ranges.
    """

    @property
    def published(self) -> Published:
        """Formulas of the literature by name: from e to the damping. None of them knows of an exit."""

    def restitution(self, damping: float, exit: str = "force") -> float:
        """The exact e at this damping: it falls from 1 as the damping grows from 0."""

    def damping(self, e: float, exit: str = "force") -> float:
        """The damping at which e is met exactly, for e from 1e-6 to 1."""


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


def check(name: str, value: object, kind: Key, cure: str = "") -> None:
    """Raises BadInput, with the name, the range and the cure, for a value which `kind` refuses."""
    try:
        kind.read(value)
    except ValueError:
        message = f"{value!r} is not accepted; accepted: {kind.accepted}{cure}"
        raise BadInput(Fault("restitution", name, message)) from None


def _checked(formula: Callable[[float], float]) -> Callable[[float], float]:
    return lambda e: formula(check_restitution(e))
