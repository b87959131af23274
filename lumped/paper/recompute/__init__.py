"""Recomputations of the paper's numbers, one example a file: a member maps names to functions of the examples.

Each returns its values, with error bars, in the unit of the claim that names it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from lumped.errors import BadInput, Fault, nearest
from lumped.paper.examples.given import Examples
from lumped.paper.examples.value import Values
from lumped.schema.members import Folder

Recomputation = Callable[[Examples], Values]
EXAMPLES = Folder[Mapping[str, Recomputation]](__name__)


def available() -> tuple[str, ...]:
    """Names of all recomputations, as "steel_ball.proposed_peak"."""
    return tuple(f"{example}.{name}" for example, functions in EXAMPLES.members.items() for name in functions)


def get(name: str) -> Recomputation:
    """The recomputation of a name; raises BadInput with the nearest one."""
    example, _, function = name.partition(".")
    if name not in available():
        raise BadInput(Fault("recompute", name, f"unknown{nearest(name, available())}"))
    return EXAMPLES.get(example)[function]
