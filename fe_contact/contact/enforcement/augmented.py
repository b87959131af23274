"""Augmented Lagrangian: the penalty's pressure becomes a multiplier, again and again, until no overlap is left.

Hestenes 1969, doi:10.1007/BF00927673: exact in the limit, whatever the penalty. Where the multiplier still changes by
more than half of its last change, the penalty grows tenfold (Bertsekas 1982, ISBN 978-0-12-093480-5), up to a bound.
The multiplier is a combination of the surface's shape functions, as the pressure of exact contact is: a facet has more
points than nodes, and would have to follow the striker at all of them.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fe_contact.contact.enforcement.base import Enforcement
from fe_contact.contact.problem import ContactProblem, ContactSolution, Touching, solve

SOLVES = 60  # at most; a stiff penalty needs some eight
SETTLED = 1e-8  # change of the multiplier, relative to its largest, at which the updates end
SLOW, STIFFER, STIFFEST = 0.5, 10.0, 1e2  # the last: times the penalty given


def enforce(problem: ContactProblem, *guesses: Touching) -> ContactSolution:
    """Solve until the multiplier stands still; an exhausted budget is reported as not converged."""
    multiplier, touching, iterations = np.zeros_like(problem.overlap), guesses[0], 0
    penalty, last = problem.penalty, np.inf
    for _ in range(SOLVES):
        found = solve(replace(problem, penalty=penalty, overlap=problem.overlap + multiplier / penalty), touching)
        iterations, touching = iterations + found.iterations, found.sets[-1]
        held = problem.surface.in_shapes(found.pressure)
        change = np.abs(held - multiplier).max()
        multiplier = held
        if not found.converged or change <= SETTLED * np.abs(multiplier).max():
            return replace(found, iterations=iterations)
        stiffer = penalty * (STIFFER if change > SLOW * last else 1.0)
        penalty, last = min(stiffer, STIFFEST * problem.penalty), change
    return replace(found, iterations=iterations, converged=False)


MEMBER = Enforcement(enforce, solves=SOLVES)
