"""One side of the ring: the place of its surface and the strains of its springs, all of them linear.

The place is measured as q = depth^exponent, so the same equations serve every exponent.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from lumped.materials import Relaxation

Array = NDArray[np.float64]


class Stage(Enum):
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

    def rate(self, state: Array, speed: Array) -> Array:
        """dq/dt = speed, dz_k/dt = dq/dt - z_k/tau_k."""
        return np.concatenate([speed[None], speed - self._slip(state)])

    def force(self, state: Array, speed: Array) -> Array:
        """E_inf q + sum E_k z_k + eta dq/dt, N."""
        return np.asarray(self._springs(state) + self.stiffness.viscosity * speed)

    def recovery(self, state: Array) -> Array:
        """The speed dq/dt at which the force stays what it is, zero."""
        if self.stiffness.viscosity:
            return -self._springs(state) / self.stiffness.viscosity
        return np.tensordot(self.stiffness.moduli, self._slip(state), 1) / self.stiffness.glassy

    def stored(self, state: Array) -> float:
        """Energy of the springs, for exponent 1, J."""
        weights = np.array([self.stiffness.equilibrium, *self.stiffness.moduli])
        return float(0.5 * weights @ state**2)

    def lost(self, state: Array, speed: Array) -> Array:
        """Power spent in the dashpots, sum E_k z_k^2/tau_k + eta (dq/dt)^2, for exponent 1, W."""
        spent = np.tensordot(self.stiffness.moduli, state[1:] * self._slip(state), 1)
        return np.asarray(spent + self.stiffness.viscosity * speed**2)

    def _springs(self, state: Array) -> Array:
        return np.tensordot([self.stiffness.equilibrium, *self.stiffness.moduli], state, 1)

    def _slip(self, state: Array) -> Array:
        """z_k/tau_k: the rate of each dashpot, shape (n, ...)."""
        times = np.array(self.stiffness.times).reshape(-1, *[1] * (state.ndim - 1))
        return np.asarray(state[1:] / times)
