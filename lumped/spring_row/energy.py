"""Energy of the springs, counted on its own: spent in dashpots, held in pressed or released springs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lumped.spring_row.row import Instant, Problem, Row

Array = NDArray[np.float64]


class Meter:
    """Adds up what the dashpots of pressed springs spend and what released springs take along."""

    def __init__(self, problem: Problem) -> None:
        self.modulus = problem.modulus
        self.stiffness = np.array(problem.modulus.moduli)[:, None]
        self.times = np.array(problem.modulus.times)[:, None]
        self.spent = 0.0
        self.released = 0.0
        self.held = 0.0
        self._last = Instant(0.0, 0.0, problem.velocity, 0.0, 0.0, 0.0)
        self._power = 0.0
        self._density = 0.0

    @property
    def energies(self) -> Array:
        """Spent in dashpots, and still held in springs, pressed or released, J, shape (2,)."""
        return np.array([self.spent, self.released + self.held])

    def observe(self, row: Row, now: Instant) -> None:
        """Count one step, the trapezoid over time and over the row."""
        x, power, density = self._densities(row, now)
        inside = min(int(x.searchsorted(now.edge, side="right")), x.size)
        places = np.append(x[:inside], now.edge)
        at_edge = float(np.interp(now.edge, x, density))
        rate = 2.0 * float(np.trapezoid(np.append(power[:inside], np.interp(now.edge, x, power)), places))
        self.held = 2.0 * float(np.trapezoid(np.append(density[:inside], at_edge), places))
        self.spent += 0.5 * (now.time - self._last.time) * (rate + self._power)
        self.released += max(self._last.edge - now.edge, 0.0) * (at_edge + self._density)
        self._last, self._power, self._density = now, rate, at_edge

    def _densities(self, row: Row, now: Instant) -> tuple[Array, Array, Array]:
        """Places of the springs; per length of one side, the power spent, W/m, and the energy held, J/m."""
        n, modulus = row.count, self.modulus
        z = row.z[:, :n]
        power = (z**2 / (self.stiffness * self.times)).sum(axis=0) + modulus.viscosity * now.velocity**2
        density = (z**2 / (2.0 * self.stiffness)).sum(axis=0)
        if modulus.equilibrium:
            density += (modulus.equilibrium * now.depth - row.rest[:n]) ** 2 / (2.0 * modulus.equilibrium)
        return row.x[:n], power, density
