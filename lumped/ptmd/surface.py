"""One side of the ring: the place of its surface and the strains of its springs, all of them linear.

The place is measured as q = depth^exponent, so the same equations serve every exponent.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lumped.materials import Relaxation

Array = NDArray[np.float64]


class SideStage(Enum):
    """What one side of the ring does."""

    PRESSED = "the damper presses the surface and feels its force"
    RECOVERING = "the surface creeps back under no force"
    FOLLOWED = "the surface follows the damper, its tension cut off"
    HELD = "the surface stays at its undeformed place"


@dataclass(frozen=True)
class Surface:
    """State (1 + n, ...): the place q, then the strain z_k of the spring of each Maxwell element."""

    stiffness: Relaxation

    @property
    def size(self) -> int:
        """Numbers in the state of a side."""
        return 1 + len(self.stiffness.moduli)

    @cached_property
    def springs(self) -> Array:
        """What the springs carry, N, per unit of the state, shape (1 + n,)."""
        return np.array([self.stiffness.equilibrium, *self.stiffness.moduli])

    @cached_property
    def creep(self) -> Array:
        """The speed dq/dt at which the force stays what it is, zero, per unit of the state, shape (1 + n,)."""
        if self.stiffness.viscosity:
            return -self.springs / self.stiffness.viscosity
        slips = np.divide(self.stiffness.moduli, self.stiffness.times)
        return np.append(0.0, slips) / self.stiffness.glassy

    def rate(self, state: Array, speed: Array) -> Array:
        """dq/dt = speed, dz_k/dt = dq/dt - z_k/tau_k."""
        return np.concatenate([speed[None], speed - self._slip(state)])

    def force(self, state: Array, speed: Array) -> Array:
        """E_inf q + sum E_k z_k + eta dq/dt, N."""
        return np.asarray(_sum(self.springs, state) + self.stiffness.viscosity * speed)

    def recovery(self, state: Array) -> Array:
        """The speed dq/dt of a surface that nothing touches."""
        return _sum(self.creep, state)

    def stored(self, state: Array) -> float:
        """Energy of the springs, for exponent 1, J."""
        return float(0.5 * self.springs @ state**2)

    def lost(self, state: Array, speed: Array) -> Array:
        """Power spent in the dashpots, sum E_k z_k^2/tau_k + eta (dq/dt)^2, for exponent 1, W."""
        spent = _sum(self.springs[1:], state[1:] * self._slip(state))
        return np.asarray(spent + self.stiffness.viscosity * speed**2)

    def _slip(self, state: Array) -> Array:
        """z_k/tau_k: the rate of each dashpot, shape (n, ...)."""
        times = np.array(self.stiffness.times).reshape(-1, *[1] * (state.ndim - 1))
        return np.asarray(state[1:] / times)


def _sum(weights: Array, values: Array) -> Array:
    """Of values (n, ...) with weights (n,)."""
    return np.asarray(np.einsum("k,k...->...", weights, values))
