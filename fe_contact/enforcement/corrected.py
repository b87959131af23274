"""Penalty with its bias removed: one augmented-Lagrangian update, no pressure law assumed.

The first pressure is added to the law as a multiplier (``overlap + pressure / penalty``), which takes
the penalty's softness out to first order and leaves the smoothness that a finite penalty gives.
"""

from __future__ import annotations

from dataclasses import replace

from fe_contact.contact import ContactProblem, ContactSolution, Touching, solve

SOLVES = 2


def enforce(problem: ContactProblem, *guesses: Touching) -> ContactSolution:
    """Solve, take the pressure as multiplier, solve again; a lone guess serves the first, its answer the second."""
    first = solve(problem, guesses[0])
    shifted = replace(problem, overlap=problem.overlap + first.pressure / problem.penalty)
    second = solve(shifted, *(guesses[1:] or first.sets))
    return ContactSolution(
        signed_pressure=second.signed_pressure,
        iterations=first.iterations + second.iterations,
        converged=first.converged and second.converged,
        sets=first.sets + second.sets,
    )
