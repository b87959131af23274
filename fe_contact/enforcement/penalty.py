"""Raw penalty: pressure proportional to what overlap is left. Softens the contact by O(1/penalty)."""

from __future__ import annotations

from fe_contact.contact import ContactProblem, ContactSolution, Touching, solve

SOLVES = 1


def enforce(problem: ContactProblem, *guesses: Touching) -> ContactSolution:
    """Solve once."""
    return solve(problem, guesses[0])
