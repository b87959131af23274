"""The linear motion of the frames over a short time, exact to rounding: a Taylor series of the state, and what forces
in the gaps add to it.

y = (q, q'), y' = A y - e a(t) + B F(t). Over a time that is short beside the shortest period the series of exp(A t)
ends at rounding after TERMS terms. Forces come in by their iterated integrals, int..int F, of which A^k B is the
influence on the state: integrals over the places of Radau's collocation, which is then Radau's method on the whole.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi, sqrt

import numpy as np

from lumped.numbers import Array
from lumped.pounding.ground import GroundMotion
from lumped.solvers.point.bodies import TINY
from lumped.solvers.radau import Nodes

LAST = 1e-17  # rounding: of the first integral of a force, in its last one that counts
ROUNDING = 1e-13  # rounding: of the displacements behind a depth: what is as near to zero is zero
FAINTEST = 1e-6  # of the fastest storey: what touches more slowly counts as so fast, for steps and laws
TERMS = 18  # rounding: 1/18! is below 2e-16
ROWS_A_PERIOD = 30.0  # look: of the longest one, so that straight lines between them miss half a per cent of it


@dataclass(frozen=True, eq=False)
class LinearBodies:
    """M q'' + C q' + K q = -M 1 a(t) - R^T F, and F >= 0 acts where the depth R q - distance is above zero.

    `mass` (n,), kg; `stiffness` and `damping` (n, n), N/m and N s/m; `rows` R (m, n) and `distances` (m,), m, of the
    gaps; `start`: displacements, m, then velocities, m/s, (2 n,). The last of q, as many as `waves`, are of waves
    within bodies: the ground does not push them, there 1 is zero.
    """

    mass: Array
    stiffness: Array
    damping: Array
    rows: Array
    distances: Array
    start: Array
    waves: int = 0

    @cached_property
    def reduced_masses(self) -> Array:
        """What the force of each gap moves as one mass, kg, (m,)."""
        return np.asarray(1.0 / (self.rows**2 / self.mass).sum(axis=1))

    def depths(self, states: Array) -> Array:
        """Of the gaps, m, (..., m), negative where they are open, in states (..., 2 n)."""
        return np.asarray(states[..., : self.mass.size] @ self.rows.T - self.distances)

    def rates(self, states: Array) -> Array:
        """Of the depths, m/s, (..., m), in states (..., 2 n)."""
        return np.asarray(states[..., self.mass.size :] @ self.rows.T)

    def accelerations(self, states: Array, forces: Array) -> Array:
        """Total ones, m/s2, (..., n), of states (..., 2 n) and forces (..., m)."""
        n = self.mass.size
        pulls = states[..., :n] @ self.stiffness + states[..., n:] @ self.damping + forces @ self.rows
        return np.asarray(-pulls / self.mass)

    def energies(self, state: Array) -> tuple[float, float]:
        """Kinetic and of strain, J."""
        n = self.mass.size
        return 0.5 * float(self.mass @ state[n:] ** 2), 0.5 * float(state[:n] @ self.stiffness @ state[:n])


def longest_row(frames: LinearBodies, ground: GroundMotion) -> float:
    """The time, s, over which every series converges like that of exp(1): about a sixth of the shortest period.

    And no more than a share of the longest one, whose picture is straight lines between the rows.
    """
    stiffness = float((np.abs(frames.stiffness).sum(axis=1) / frames.mass).max())
    damping = float((np.abs(frames.damping).sum(axis=1) / frames.mass).max()) + ground.fastest
    root = damping + sqrt(damping**2 + 4.0 * stiffness)
    shares = frames.stiffness / np.sqrt(np.outer(frames.mass, frames.mass))
    slowest = sqrt(max(float(np.linalg.eigvalsh(shares)[0]), 0.0)) * ROWS_A_PERIOD / (2.0 * pi)
    return 1.0 / max(0.5 * root, slowest) if root > 0.0 else np.inf


@dataclass(frozen=True, eq=False)
class FrameFlow:
    """What is known of the motion once for all; time counts in `unit`, s, no step is longer."""

    frames: LinearBodies
    unit: float

    @property
    def size(self) -> int:
        """Storeys of all frames, n."""
        return self.frames.mass.size

    @cached_property
    def matrix(self) -> Array:
        """A unit, shape (2 n, 2 n)."""
        n, inverse = self.size, 1.0 / self.frames.mass[:, None]
        matrix = np.zeros((2 * n, 2 * n))
        matrix[:n, n:] = np.eye(n)
        matrix[n:, :n], matrix[n:, n:] = -inverse * self.frames.stiffness, -inverse * self.frames.damping
        return self.unit * matrix

    @cached_property
    def _powers(self) -> Array:
        """(A unit)^k/k!, shape (TERMS + 1, 2 n, 2 n)."""
        powers = [np.eye(2 * self.size)]
        for k in range(1, TERMS + 1):
            powers.append(self.matrix @ powers[-1] / k)
        return np.array(powers)

    @cached_property
    def _shaken(self) -> Array:
        """What each Taylor coefficient of the ground gives to those of the state: (TERMS + 1, 2 n, TERMS)."""
        shaken = np.zeros((TERMS + 1, 2 * self.size, TERMS))
        for k in range(TERMS):
            shaken[k + 1] = self.matrix @ shaken[k]
            shaken[k + 1, self.size : 2 * self.size - self.frames.waves, k] -= self.unit
            shaken[k + 1] /= k + 1
        return shaken

    def series(self, state: Array, ground: Array) -> Array:
        """Taylor coefficients of the free motion over time/unit from `state` on, (TERMS + 1, 2 n)."""
        shaken = self._shaken @ ground if ground.any() else 0.0
        return np.asarray(self._powers @ state + shaken)

    @cached_property
    def influence(self) -> Array:
        """Of the (k + 1)-th iterated integral of the forces on the state, (A unit)^k B unit, and so on the depths and
        the rates: (TERMS, 2 n + 2 m, m).
        """
        push = np.zeros((2 * self.size, self.frames.distances.size))
        push[self.size :] = -self.unit * self.frames.rows.T / self.frames.mass[:, None]
        found = [push]
        for _ in range(TERMS - 1):
            found.append(self.matrix @ found[-1])
        states = np.array(found)
        rows = self.frames.rows
        return np.concatenate([states, rows @ states[:, : self.size], rows @ states[:, self.size :]], axis=1)

    @cached_property
    def _behind(self) -> Array:
        """Whose displacements stand behind a depth, (m, n)."""
        return np.abs(self.frames.rows)

    def noise(self, free: Array) -> Array:
        """Depths that are zero but for rounding, m, (..., m), where a free motion has coefficients (..., k, n)."""
        farthest = np.abs(free[..., : self.size]).sum(axis=-2) @ self._behind.T
        return np.asarray(ROUNDING * (farthest + self.frames.distances) + TINY)

    def slowest(self, free: Array) -> float:
        """A speed, m/s, below which storeys touch so gently that it does not matter how."""
        return FAINTEST * float(np.abs(free[:, self.size :]).sum(axis=0).max()) + TINY

    def shares(self, nodes: Nodes, length: float) -> Array:
        """(time/unit)^k at the points of a step of `length`, s: shape (s, TERMS + 1)."""
        return np.asarray((length / self.unit * nodes.points)[:, None] ** np.arange(TERMS + 1.0))

    def integrals(self, nodes: Nodes, length: float) -> Array:
        """Matrices from pace times a force to its iterated integrals at the points of a step: (k, s, s).

        As many as count: the k-th falls with the k-th power of the length over k!.
        """
        first = length / self.unit * nodes.once
        found, again, size = [first], first * nodes.pace, 1.0
        while len(found) < TERMS and size > LAST:
            found.append(again @ found[-1])
            size *= length / self.unit / len(found)
        return np.array(found)
