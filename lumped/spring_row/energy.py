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
        stiffness, times = np.array(problem.modulus.moduli), np.array(problem.modulus.times)
        # A spring of stiffness E with the force z in series with a dashpot E tau spends z^2/(E tau) and holds z^2/(2E).
        self.shares = np.array([1.0 / (stiffness * times), 0.5 / stiffness])
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
        x, both = row.x[: row.count], self._densities(row, now)
        pressed = min(int(x.searchsorted(now.edge, side="right")), x.size)
        beyond = now.edge - x[pressed - 1]
        at_edge = both[:, pressed - 1]
        if pressed < x.size:
            at_edge = at_edge + (both[:, pressed] - at_edge) * (beyond / (x[pressed] - x[pressed - 1]))
        inside = both[:, :pressed]
        cells = (inside[:, 1:] + inside[:, :-1]) @ (x[1:pressed] - x[: pressed - 1])
        # Half of the trapezoid's sums, twice for the two sides.
        power, self.held = (cells + beyond * (inside[:, -1] + at_edge)).tolist()
        density = float(at_edge[1])
        self.spent += 0.5 * (now.time - self._last.time) * (power + self._power)
        self.released += max(self._last.edge - now.edge, 0.0) * (density + self._density)
        self._last, self._power, self._density = now, power, density

    def _densities(self, row: Row, now: Instant) -> Array:
        """Per length of one side at every spring, the power spent, W/m, and the energy held, J/m, shape (2, n)."""
        n, modulus = row.count, self.modulus
        z = row.z[:, :n]
        both: Array = np.dot(self.shares, z * z)
        if modulus.viscosity:
            both[0] += modulus.viscosity * now.velocity**2
        if modulus.equilibrium:
            both[1] += (modulus.equilibrium * now.depth - row.rest[:n]) ** 2 / (2.0 * modulus.equilibrium)
        return both
