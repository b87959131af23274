"""Damping against the coefficient of restitution, one family a file, found by its name.

Each member is a `Family`: `restitution(damping, exit)` and `damping(e, exit)` are exact, `published` holds the
approximations of the literature.
"""

from __future__ import annotations

from lumped.errors import BadInput as _BadInput
from lumped.errors import Fault as _Fault
from lumped.errors import nearest as _nearest
from lumped.restitution.base import Family as Family
from lumped.schema.members import Folder as _Folder

EXACT = "exact"
_FAMILIES = _Folder[Family](__name__, source="restitution")


def available() -> tuple[str, ...]:
    """Names of the families."""
    return _FAMILIES.names


def get(name: str) -> Family:
    """The family called so; raises BadInput with the nearest name."""
    return _FAMILIES.get(name)


def damping(family: Family, e: float, exit: str = "force", formula: str = EXACT) -> float:
    """The family's damping for e: exact at this exit, or by a published formula, which knows of no exit.

    Raises BadInput, for an unknown formula with the nearest name.
    """
    if formula == EXACT:
        return family.damping(e, exit)
    names = (EXACT, *family.published)
    if formula not in names:
        message = f"{formula!r} is not known; accepted: {', '.join(names)}{_nearest(formula, names)}"
        raise _BadInput(_Fault("restitution", "formula", message))
    return family.published[formula](e)


def __getattr__(name: str) -> Family:
    """The family, imported when it is first asked for: `lumped.restitution.kelvin`."""
    if name in available():
        return get(name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
