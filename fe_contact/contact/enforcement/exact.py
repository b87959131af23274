"""No overlap at all: a primal-dual active set on the nodes, the penalty's limit 1/stiffness = 0.

The pressure is a combination of the surface's shape functions, and the overlap vanishes in their mean wherever it
acts: with weighted overlaps G = N^T W (g - T x - y) and nodal pressures P, G <= 0, P >= 0, P G = 0 (Hintermüller, Ito
and Kunisch 2002, doi:10.1137/S1052623401383558). Single points would be too many: they would hold a whole facet.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.contact import problem as contact
from fe_contact.contact.enforcement.base import Enforcement
from fe_contact.contact.problem import ContactProblem, ContactSolution, PressedSurface, Touching

SURFACES_KEPT = 8  # work: memory, surfaces whose dense system is kept


def enforce(problem: ContactProblem, *guesses: Touching) -> ContactSolution:
    """Solve; a set of nodes that cycles is reported as not converged."""
    surface = problem.surface
    shapes, test, yielding = _system(surface)
    retreat = test @ np.broadcast_to(problem.yielding, surface.weights.shape)
    yielding = yielding + np.outer(test.sum(axis=1), retreat)
    free = test @ problem.overlap
    size = np.abs(np.diag(yielding))  # pressure and overlap in one unit
    reach = np.abs(test)
    held = reach @ guesses[0] > 0.5 * reach.sum(axis=1)
    for iteration in range(1, contact.MAX_ITERATIONS + 1):
        pressure = np.zeros_like(free)
        pressure[held] = np.linalg.solve(yielding[np.ix_(held, held)], free[held])
        signed = np.where(held, pressure, (free - yielding @ pressure) / size)
        if (held == (signed > 0.0)).all():
            return _solution(shapes @ signed, iteration, True)
        held = signed > 0.0
    return _solution(shapes @ signed, iteration, False)


@lru_cache(maxsize=SURFACES_KEPT)
def _system(surface: PressedSurface) -> tuple[Array, Array, Array]:
    """Shape functions of the pressure (q, n), the same as weighted tests (n, q), and how they yield, (n, n)."""
    shapes = independent(surface.trace) if surface.carriers is None else surface.carriers
    test = shapes.T * surface.weights
    loads = surface.trace.T @ test.T
    return shapes, test, loads.T @ np.linalg.solve(surface.stiffness, loads)


def independent(trace: Array) -> Array:
    """The columns that span all of them: a rigid striker, which comes last, is a sum of shape functions."""
    return trace[:, : np.linalg.matrix_rank(trace)]


def _solution(signed_pressure: Array, iterations: int, converged: bool) -> ContactSolution:
    """Where open, the signed pressure is the overlap's, negative."""
    return ContactSolution(signed_pressure, iterations, converged, (signed_pressure > 0.0,))


MEMBER = Enforcement(enforce, nodewise=True)
