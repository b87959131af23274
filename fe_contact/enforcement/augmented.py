"""Augmented Lagrangian: the penalty's pressure becomes a multiplier, again and again, until no overlap is left.

Hestenes 1969, doi:10.1007/BF00927673: exact in the limit, whatever the penalty. Where the pressure still changes by
more than a quarter of its last change, the penalty grows tenfold (Bertsekas 1982, ISBN 978-0-12-093480-5), up to a
bound. Where a facet has more points than nodes many pressures do, and the budget may end first: not converged.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fe_contact.contact import ContactProblem, ContactSolution, Touching, solve

SOLVES = 60  # at most; a stiff penalty needs some eight
SETTLED = 1e-10  # change of the pressure, relative to its largest, at which the updates end
SLOW, STIFFER, STIFFEST = 0.25, 10.0, 1e4  # the last: times the penalty given


def enforce(problem: ContactProblem, *guesses: Touching) -> ContactSolution:
    """Solve until the multiplier stands still; an exhausted budget is reported as not converged."""
    multiplier, touching, iterations = np.zeros_like(problem.overlap), guesses[0], 0
    penalty, last = problem.penalty, np.inf
    for _ in range(SOLVES):
        found = solve(replace(problem, penalty=penalty, overlap=problem.overlap + multiplier / penalty), touching)
        iterations, touching = iterations + found.iterations, found.sets[-1]
        change = np.abs(found.pressure - multiplier).max()
        multiplier = found.pressure
        if not found.converged or change <= SETTLED * multiplier.max(initial=0.0):
            return replace(found, iterations=iterations)
        stiffer = penalty * (STIFFER if change > SLOW * last else 1.0)
        penalty, last = min(stiffer, STIFFEST * problem.penalty), change
    return replace(found, iterations=iterations, converged=False)
