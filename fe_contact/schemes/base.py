"""What a scheme without inertia is: numbers, and how a step integrates the branches of a relaxation modulus."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from fe_contact.assembly.forms import Array
from lumped.schema.members import Folder


@dataclass(frozen=True)
class MemoryScheme:
    """``order`` of accuracy in the step length. ``sample``: the share of the step at which its force belongs, and the
    share of the displacement increment that the equilibrium spring feels. ``lever``: displacement of a free mass by
    a constant force over a step, a ratio to force dt^2 / mass.

    ``weights(moduli, ratios)``: for branches of modulus E_k and ratio x_k = dt/tau_k, (k,), their share of the step's
    stress per displacement increment, and their weight on the branch's own past.
    """

    order: int
    sample: float
    lever: float
    weights: Callable[[Array, Array], tuple[Array, Array]]


SCHEMES = Folder[MemoryScheme]("fe_contact.schemes", "numerics", "scheme")
