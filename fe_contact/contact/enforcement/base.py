"""What a way to keep two surfaces apart is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from fe_contact.assembly.forms import Array
from fe_contact.contact.problem import ContactProblem, ContactSolution, Touching
from lumped.schema.members import Folder


class Enforce(Protocol):
    """Solves a contact problem."""

    def __call__(self, problem: ContactProblem, *guesses: Touching) -> ContactSolution:
        """From first guesses of the touching points, one or one for each contact problem it solves."""


@dataclass(frozen=True)
class Enforcement:
    """``solves``: contact problems that it costs at most; ``soft``: whether its answer depends on the penalty;
    ``nodewise``: whether its contact grows by whole nodes.

    ``law(overlap, penalty)``: signed pressure (q,), Pa, where it follows from the overlap (q,), m, alone; else None.
    """

    enforce: Enforce
    solves: int = 1
    soft: bool = False
    nodewise: bool = False
    law: Callable[[Array, float], Array] | None = None

    @property
    def settling(self) -> str:
        """What helps a contact to settle: softer springs, but stiffer ones where updates add up to what they lack."""
        if self.nodewise:
            return "another numerics.enforcement"
        return f"a {'lower' if self.soft else 'higher'} numerics.penalty"


ENFORCEMENTS = Folder[Enforcement]("fe_contact.contact.enforcement", "numerics", "enforcement")
