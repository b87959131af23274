"""What an integrator is: where in the step it balances forces, and Newmark's two weights."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from lumped.schema.members import Folder


class Scheme(NamedTuple):
    """Balance of inertia at 1 - ``alpha_m`` of the step, of forces at 1 - ``alpha_f``, between

    u' = u + dt v + dt^2 [(1/2 - beta) a + beta a'] ,    v' = v + dt [(1 - gamma) a + gamma a'] .

    ``beta`` = 0: the displacement at the step's end needs no solution. ``staged``: whether a step is taken in as many
    equal stages as it asks for.
    """

    alpha_m: float
    alpha_f: float
    beta: float
    gamma: float
    staged: bool = False

    @property
    def explicit(self) -> bool:
        """Whether displacements come before accelerations."""
        return self.beta == 0.0


@dataclass(frozen=True)
class Family:
    """``of(rho)``: the scheme whose spectral radius for infinitely fast oscillations is ``rho``, as far as the family
    leaves a choice.
    """

    of: Callable[[float], Scheme]


WAVE_SCHEMES = Folder[Family]("fe_contact.dynamics.schemes", "numerics", "scheme")
