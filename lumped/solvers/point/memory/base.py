"""The contract of a rule: when two bodies meet again after a contact, and what the material still remembers."""

from __future__ import annotations

from typing import Protocol

from lumped.solvers.point.bodies import Bodies, State
from lumped.solvers.point.hereditary import HereditaryLoad


class MemoryRule(Protocol):
    """A module of this folder."""

    def returned(self, load: HereditaryLoad, bodies: Bodies, last: State) -> tuple[float, State] | None:
        """How long the bodies are apart, s, and the state when contact begins again; None: they never meet."""
