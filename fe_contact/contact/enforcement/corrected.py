"""Penalty with its bias removed: one augmented-Lagrangian update, no pressure law assumed.

The first pressure is added to the law as a multiplier (``overlap + pressure / penalty``), which takes
the penalty's softness out to first order and leaves the smoothness that a finite penalty gives.
"""

from __future__ import annotations

from dataclasses import replace

from fe_contact.contact.enforcement.base import Enforcement
from fe_contact.contact.problem import ContactProblem, ContactSolution, Touching, count, moved, solve


def enforce(problem: ContactProblem, *guesses: Touching) -> ContactSolution:
    """Solve, take the pressure as multiplier, solve again.

    A second guess tells by how many points the second set differs from the first; without it, by none.
    """
    first = solve(problem, guesses[0])
    shifted = replace(problem, overlap=problem.overlap + first.pressure / problem.penalty)
    second = solve(shifted, moved(first.sets[0], count(guesses[-1]) - count(guesses[0])))
    return ContactSolution(
        signed_pressure=second.signed_pressure,
        iterations=first.iterations + second.iterations,
        converged=first.converged and second.converged,
        sets=first.sets + second.sets,
    )


MEMBER = Enforcement(enforce, solves=2, soft=True)
