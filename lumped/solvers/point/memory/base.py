"""The contract of a rule: when two bodies meet again after a contact, and what the material still remembers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from lumped.solvers.point.bodies import Bodies, State
from lumped.solvers.point.hereditary import HereditaryLoad


@dataclass(frozen=True)
class MemoryRule:
    """A member of this folder.

    `returned`: from a load, its bodies and the state in which they parted, how long they are apart, s, and the state
    when contact begins again; None: they never meet.
    """

    returned: Callable[[HereditaryLoad, Bodies, State], tuple[float, State] | None]
