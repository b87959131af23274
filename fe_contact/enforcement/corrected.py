"""Penalty with its bias removed: one augmented-Lagrangian update, no pressure law assumed.

The first pressure is added to the law as a multiplier (``overlap + pressure / penalty``), which takes
the penalty's softness out to first order and leaves the smoothness that a finite penalty gives.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from fe_contact.contact import ContactProblem, ContactSolution, solve

SOLVES = 2


def enforce(problem: ContactProblem, touching: npt.NDArray[np.bool_]) -> ContactSolution:
    """Solve, take the pressure as multiplier, solve again."""
    first = solve(problem, touching)
    shifted = replace(problem, overlap=problem.overlap + first.pressure / problem.penalty)
    second = solve(shifted, first.signed_pressure > 0.0)
    return replace(
        second,
        iterations=first.iterations + second.iterations,
        converged=first.converged and second.converged,
    )
