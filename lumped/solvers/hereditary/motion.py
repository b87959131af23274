"""One piece of the motion under F = int E(t-s) dy(s): the memory is a matrix, the acceleration is found by Newton.

Over a piece the acceleration is a polynomial through the nodes. Velocity and depth are its integrals, and each
memory solves z = z0 + y - y0 - (1/tau) int z dt, which is linear: z = (1 + W/tau)^-1 (z0 + y - y0).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.solvers.hereditary.march import HereditaryPiece
from lumped.solvers.hereditary.problem import Hereditary
from lumped.solvers.hereditary.radau import Radau

Array = NDArray[np.float64]
NEWTON_STEPS = 14
# Newton's last correction, relative: what is left after it is its square, or as many times less as its square is less
# than that of the one before. At rest, where accelerations are rounding, the square of this share of gravity and depth.
CONVERGED, DIVERGED = 1e-6, 1e100


@dataclass(frozen=True, eq=False)
class PieceMotion:
    """Times since the start of the piece at its nodes, (N,), and `weights`, (N, N), of integrals over time."""

    problem: Hereditary
    elapsed: Array
    weights: Array

    @classmethod
    def over_root(cls, problem: Hereditary, table: Radau, root: float, length: float) -> PieceMotion:
        """The piece from `root` over this length in r = sqrt(t)."""
        step = length * table.nodes
        return cls(problem, step * (2.0 * root + step), 2.0 * length * table.integral * (root + step))

    @classmethod
    def to_end(cls, problem: Hereditary, table: Radau, duration: float) -> PieceMotion:
        """The piece of this duration in the root of the time left: there contact closes smoothly."""
        left = 1.0 - table.nodes
        return cls(problem, duration * (1.0 - left * left), 2.0 * duration * table.integral * left)

    def piece(self, state: Array, guess: float | Array) -> HereditaryPiece | None:
        """The piece from a state, (4 + K,), the acceleration guessed; None where Newton's steps fail."""
        problem, weights = self.problem, self.weights
        modulus = problem.modulus
        # (1 + W/tau_k)^-1, shape (K, N, N): the rise of a memory by the rise of what it remembers.
        eye = np.eye(self.elapsed.size)
        answers = np.asarray(np.linalg.inv(eye + weights * problem.rates[:, None, None]), dtype=float)
        response = np.einsum("k,kij->ij", problem.stiffnesses, answers) + modulus.equilibrium * eye
        left = (problem.stiffnesses * state[4:]) @ answers.sum(axis=2)
        twice, coasted = weights @ weights, state[0] + state[1] * self.elapsed
        a, before = np.full(self.elapsed.size, guess), 0.0
        for step in range(1, NEWTON_STEPS + 1):
            depth = coasted + twice @ a
            load, slopes = problem.loads(np.concatenate([state[:1], depth]))
            rise, slope = load[1:] - load[0], slopes[1:]
            force = response @ rise + modulus.equilibrium * load[0] + left
            matrix = (response * slope) @ twice
            if modulus.viscosity:
                velocity, bend = state[1] + weights @ a, problem.bend(depth, slope)
                force += modulus.viscosity * slope * velocity
                matrix += modulus.viscosity * (slope[:, None] * weights + (bend * velocity)[:, None] * twice)
            change = np.linalg.solve(matrix + eye, problem.gravity - force - a)
            a += change
            size = math.sqrt(change @ change)
            if not size < DIVERGED:
                return None
            allowed = CONVERGED**2 * math.sqrt(a @ a)
            rests = size <= CONVERGED**2 * abs(problem.gravity) and np.all(
                np.abs(twice @ change) <= CONVERGED**2 * np.abs(depth)
            )
            if rests or size * CONVERGED <= allowed or size**3 <= allowed * before**2:
                return HereditaryPiece(self._values(state, a, rise + slope * (twice @ change), answers), step)
            before = size
        return None

    def _values(self, state: Array, a: Array, rise: Array, answers: Array) -> Array:
        """The fields at the first place and the nodes; `rise` is by how much the load has grown."""
        weights = self.weights
        velocity, force = state[1] + weights @ a, self.problem.gravity - a
        depth = state[0] + weights @ velocity
        values = np.empty((state.size, a.size + 1))
        values[:, 0] = state
        values[0, 1:], values[1, 1:], values[3, 1:] = depth, velocity, force
        values[2, 1:] = state[2] + weights @ (force * velocity)
        if self.problem.terms:
            values[4:, 1:] = (answers @ (state[4:, None] + rise)[..., None])[..., 0]
        return values
