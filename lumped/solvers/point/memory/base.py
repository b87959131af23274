"""What a material remembers under a load, and the contract of a rule of what it does between two contacts.

F = int E*(t-s) dy, "(17)" to "(19)", at the Radau points of a step: the Maxwell branches by collocation too. With
w_k' = (y - w_k)/tau_k the force is E_glassy y - sum E_k w_k + eta y'. At the points of one step w_k is linear in
the loads y there, w_k = q_k w_k(0) + L_k y, so the force is too: F = b + B y.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.load_curves.base import LoadCurve
from lumped.materials import Relaxation
from lumped.numbers import Real
from lumped.solvers.point.bodies import Bodies, State
from lumped.solvers.point.nodes import Nodes

Array = NDArray[np.float64]


@dataclass(frozen=True)
class HereditaryLoad:
    """An elastic load curve y(depth), m2, under the modulus E*(t), Pa; memories w_k in m2."""

    curve: LoadCurve
    modulus: Relaxation

    @property
    def at_rest(self) -> tuple[float, ...]:
        """The memory of a relaxed surface."""
        return (0.0,) * len(self.modulus.moduli)

    def load(self, depth: Real) -> Real:
        """y, zero above the surface."""
        return self.curve.force(np.maximum(depth, 0.0))

    def slope(self, depth: Real) -> Real:
        """dy/d depth."""
        return self.curve.dforce_ddepth(np.maximum(depth, 0.0))

    def slope_slope(self, depth: Array) -> Array:
        """d2y/d depth2 = 2 da/d depth, zero where the depth is."""
        radius = np.asarray(self.curve.contact_radius(depth))
        over_radius = np.asarray(self.curve.depth_slope(radius))
        return np.asarray(np.divide(2.0, over_radius, out=np.zeros_like(radius), where=over_radius > 0.0))

    def force(self, depth: Real, rate: Real, memory: Real) -> Array:
        """F, N; `memory` has the branches first, shape (K, ...)."""
        remembered = np.tensordot(np.array(self.modulus.moduli), np.asarray(memory), axes=(0, 0))
        viscous = self.modulus.viscosity * self.slope(depth) * rate
        return np.asarray(self.modulus.glassy * self.load(depth) - remembered + viscous)


@dataclass(frozen=True, eq=False)
class StepLoad:
    """A hereditary load within one step: gains q, shape (K, s), and L, shape (K, s, s); memory at its start (K,)."""

    load: HereditaryLoad
    memory: Array
    gains: Array
    response: Array

    @classmethod
    def of(cls, load: HereditaryLoad, memory: tuple[float, ...], length: float, nodes: Nodes) -> StepLoad:
        """For a step of `length`, s: (I + A h/tau) w = w(0) + (A h/tau) y with A the collocation's integrals."""
        terms = load.modulus.times
        one = np.eye(nodes.points.size)
        driven = np.array([nodes.once * (length / tau) for tau in terms]).reshape(-1, *one.shape)
        response = np.linalg.solve(one + driven, driven)
        gains = 1.0 - response.sum(axis=2)
        return cls(load, np.array(memory), gains, response)

    def memories(self, depth: Array) -> Array:
        """w_k at the points from the depths there, shape (K, s)."""
        return np.asarray(self.gains * self.memory[:, None] + self.response @ self.load.load(depth))

    def force(self, depth: Array, rate: Array) -> Array:
        """F at the points, N."""
        return np.asarray(self.load.force(depth, rate, self.memories(depth)))

    def tangents(self, depth: Array, rate: Array) -> tuple[Array, Array]:
        """dF/d depth, shape (s, s), and dF/d rate, shape (s,)."""
        modulus, slope = self.load.modulus, np.asarray(self.load.slope(depth))
        remembered = np.tensordot(np.array(modulus.moduli), self.response, axes=(0, 0))
        over_depth = -remembered * slope
        bent = modulus.viscosity * rate * self.load.slope_slope(depth) if modulus.viscosity else 0.0
        over_depth.flat[:: depth.size + 1] += modulus.glassy * slope + bent
        return over_depth, modulus.viscosity * slope


@dataclass(frozen=True)
class MemoryRule:
    """A member of this folder.

    `returned`: from a load, its bodies and the state in which they parted, how long they are apart, s, and the state
    when contact begins again; None: they never meet.
    """

    returned: Callable[[HereditaryLoad, Bodies, State], tuple[float, State] | None]
