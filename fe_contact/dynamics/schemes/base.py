"""What an integrator is: where in the step it balances forces, and Newmark's two weights."""

from __future__ import annotations

from typing import NamedTuple


class Scheme(NamedTuple):
    """Balance of inertia at 1 - ``alpha_m`` of the step, of forces at 1 - ``alpha_f``, between

    u' = u + dt v + dt^2 [(1/2 - beta) a + beta a'] ,    v' = v + dt [(1 - gamma) a + gamma a'] .

    ``beta`` = 0: the displacement at the step's end needs no solution.
    """

    alpha_m: float
    alpha_f: float
    beta: float
    gamma: float

    @property
    def explicit(self) -> bool:
        """Whether displacements come before accelerations."""
        return self.beta == 0.0

    @property
    def staged(self) -> bool:
        """Whether a step is taken in as many equal stages as it asks for."""
        return False
