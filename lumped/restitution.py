"""Damping against the coefficient of restitution, by the laws that have a relation of their own.

Each is a `Family`: `restitution(damping, exit)` and `damping(e, exit)` are exact, `published` holds the
approximations of the literature.
"""

from __future__ import annotations

from lumped import laws
from lumped.errors import BadInput, Fault
from lumped.laws._damping import EXACT as EXACT
from lumped.laws._damping import Family as Family
from lumped.laws._damping import damping as damping
from lumped.schema.members import unavailable


def available() -> tuple[str, ...]:
    """Names of the laws that have a family."""
    return tuple(name for name in laws.available() if laws.get(name).family)


def get(name: str) -> Family:
    """The family of the law called so; raises BadInput with the nearest name."""
    family = laws.get(name).family if name in laws.available() else None
    if family is None:
        raise BadInput(Fault("restitution", "name", unavailable(available(), name)))
    return family


def __getattr__(name: str) -> Family:
    """The family, found when it is first asked for: `lumped.restitution.kelvin`."""
    if name in laws.available() and (family := laws.get(name).family):
        return family
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
