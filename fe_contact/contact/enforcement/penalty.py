"""Raw penalty: pressure proportional to what overlap is left. Softens the contact by O(1/penalty)."""

from __future__ import annotations

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.contact.enforcement.base import Enforcement
from fe_contact.contact.problem import ContactProblem, ContactSolution, Touching, solve


def enforce(problem: ContactProblem, *guesses: Touching) -> ContactSolution:
    """Solve once."""
    return solve(problem, guesses[0])


def signed_pressure(overlap: Array, penalty: float) -> Array:
    """The law itself, where the overlap (q,) is known: Pa, negative where open."""
    return np.asarray(penalty * overlap)


MEMBER = Enforcement(enforce, soft=True, law=signed_pressure)
