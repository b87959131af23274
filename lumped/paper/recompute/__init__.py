"""Recomputations of the paper's numbers, one example a file: `RECOMPUTED` maps names to functions of the examples.

Each returns its values, with error bars, in the unit of the claim that names it.
"""

from __future__ import annotations

from collections.abc import Callable

from lumped.errors import BadInput, Fault, nearest
from lumped.paper.examples.given import Examples
from lumped.paper.examples.value import Values
from lumped.schema import members as _members

Recomputation = Callable[[Examples], Values]


def available() -> tuple[str, ...]:
    """Names of all recomputations, as "steel_ball.proposed_peak"."""
    modules = _members.available(__name__)
    return tuple(f"{module}.{name}" for module in modules for name in _members.get(__name__, module).RECOMPUTED)


def get(name: str) -> Recomputation:
    """The recomputation of a name; raises BadInput with the nearest one."""
    module, _, function = name.partition(".")
    if name not in available():
        raise BadInput(Fault("recompute", name, f"unknown{nearest(name, available())}"))
    found: Recomputation = _members.get(__name__, module).RECOMPUTED[function]
    return found
