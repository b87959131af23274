"""A dent in the end of a rod: the force that a half-space of its material would answer with, given by the model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fe_contact.contact.problem import ContactProblem, ContactSolution, Touching
from lumped.load_curves.base import LoadCurve

MOST = 60
PRECISE = 1e-13  # of the overlap


@dataclass(frozen=True)
class Dent:
    """A way to keep rod and striker apart at one point: force = modulus x load curve of the overlap that is left."""

    modulus: float
    curve: LoadCurve
    SOLVES: ClassVar[int] = 1

    def enforce(self, problem: ContactProblem, *guesses: Touching) -> ContactSolution:
        """Newton on dent + yielding x force = overlap, convex, from above; a budget used up is not converged."""
        trace, free = problem.surface.trace, float(problem.overlap[0])
        yielding = float(trace[0] @ np.linalg.solve(problem.surface.stiffness, trace[0]))
        dent, iteration = free, 0
        while dent > 0.0 and iteration < MOST:
            iteration += 1
            force, slope = self._force(dent)
            change = (dent + yielding * force - free) / (1.0 + yielding * slope)
            dent -= change
            if abs(change) <= PRECISE * free:
                break
        signed = np.array([self._force(dent)[0] if dent > 0.0 else dent])
        return ContactSolution(signed, iteration, iteration < MOST, (signed > 0.0,))

    def _force(self, dent: float) -> tuple[float, float]:
        """N, and N/m."""
        force, slope = self.curve.force_and_slope(dent)
        return self.modulus * float(force), self.modulus * float(slope)
