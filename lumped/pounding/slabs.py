"""The floor of a storey as an elastic rod that is struck at one end, by its modes.

With s from the struck end and q the mean displacement, u = q + sum_k q_k cos(k pi s/length): each mode is an oscillator
of half the rod's mass, and a gap sees q + sum_k q_k. The storey's mass lies evenly along the rod and its columns pull
evenly, so that columns and ground act on the mean alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt
from typing import Annotated, ClassVar, NamedTuple

import numpy as np

from lumped.numbers import Array
from lumped.schema.keys import Choice, Count, Key, Number, Record

MOST_STOREYS, MOST_MODES = 50, 200  # work: of one frame, of all slabs together
SIDES = ("left", "right")
STOREY = Count(1, MOST_STOREYS)


class SlabModes(NamedTuple):
    """Of shapes of a rod that are 1 at its struck end: mass, kg, stiffness, N/m, and damping, N s/m, each (n,)."""

    mass: Array
    stiffness: Array
    damping: Array


NO_MODES = SlabModes(np.zeros(0), np.zeros(0), np.zeros(0))


@dataclass(frozen=True)
class Slab(Record):
    """The floor of one storey, whose whole mass it has: its area is mass/(density length). Raises BadInput."""

    structure: Annotated[str, Key(Choice(SIDES), "which one it belongs to")]
    storey: Annotated[int, Key(STOREY, "whose floor it is, the lowest is 1")]
    length: Annotated[float, Key(Number(1e-3, 1e4, "m"), "from the struck end to the free one")]
    modulus: Annotated[float, Key(Number(1.0, 1e15, "Pa"), "along it")]
    density: Annotated[float, Key(Number(1e-3, 1e6, "kg/m3"), "with what it carries")]
    damping_ratio: Annotated[float, Key(Number(0.0, 1.0), "of its modes")] = 0.0
    modes: Annotated[int, Key(Count(4, MOST_MODES), "that are followed")] = 4
    name: ClassVar[str] = "slab"

    @property
    def at(self) -> str:
        """The name of its storey."""
        return f"{self.structure}_{self.storey}"

    @property
    def passage(self) -> float:
        """How long a wave takes along it, s."""
        return self.length * sqrt(self.density / self.modulus)

    def waves(self, mass: float, halvings: int = 0) -> SlabModes:
        """Its modes, and all higher ones as one shape more: what each yields at the struck end under a steady force.

        Of higher modes that is the sum of 1/(m_k w_k^2), and of 1/(m_k w_k^4) the kinetic energy that goes with it
        (Rubin 1975, doi 10.2514/3.60497). `mass`: the storey's, kg; `halvings`: of the modes followed, two at most.
        """
        from scipy.special import zeta  # late: only slabs need it

        first, count = pi / self.passage, self.modes >> halvings
        yields, carries = (2.0 / (mass * first**power) * float(zeta(power, count + 1)) for power in (2, 4))
        masses = np.append(np.full(count, 0.5 * mass), carries / yields**2)
        stiffness = np.append(0.5 * mass * (first * np.arange(1.0, count + 1.0)) ** 2, 1.0 / yields)
        return SlabModes(masses, stiffness, 2.0 * self.damping_ratio * np.sqrt(masses * stiffness))
