"""The equations of motion of a striker on a material with memory, without dimension."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.load_curves import LoadCurve
from lumped.materials import Relaxation

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Scales:
    """What one unit of time, velocity, depth and force is, SI; and the elastic load y0, m2, that `unit`
    carries it with.

    `unit` is a modulus, Pa: unit * y0 = force.
    """

    time: float
    velocity: float
    mass: float
    unit: float

    @property
    def depth(self) -> float:
        """m."""
        return self.velocity * self.time

    @property
    def force(self) -> float:
        """N."""
        return self.mass * self.velocity / self.time

    @property
    def load(self) -> float:
        """m2."""
        return self.force / self.unit


@dataclass(frozen=True)
class Hereditary:
    """F(t) = int E(t-s) dy(s) with y the elastic load curve, "(17)" to "(19)" as a convolution.

    `modulus` is E*(t) in units of `scales.unit` and `scales.time`; `gravity` in v/T. With z_k' = y' -
    z_k/tau_k the force is E_inf y + sum E_k z_k + eta y'. The memories of the depth obey the same, x_k' =
    depth' - x_k/tau_k.
    """

    scales: Scales
    curve: LoadCurve
    modulus: Relaxation
    gravity: float

    @classmethod
    def of(
        cls, curve: LoadCurve, modulus: Relaxation, mass: float, velocity: float, gravity: float, time: float
    ) -> Hereditary:
        """From values in SI; `time` is the unit of time, s."""
        unit = modulus.relaxed or modulus.glassy or modulus.viscosity / time
        taus = tuple(tau / time for tau in modulus.times)
        moduli = tuple(value / unit for value in modulus.moduli)
        plain = Relaxation(modulus.equilibrium / unit, moduli, taus, modulus.viscosity / (unit * time))
        return cls(Scales(time, velocity, mass, unit), curve, plain, gravity * time / velocity)

    @property
    def terms(self) -> int:
        """Number of Prony terms K."""
        return len(self.modulus.moduli)

    @property
    def stiffnesses(self) -> Array:
        """Moduli E_k, shape (K,)."""
        return np.array(self.modulus.moduli)

    @property
    def rates(self) -> Array:
        """1/tau_k, shape (K,)."""
        return 1.0 / np.array(self.modulus.times)

    def load(self, depth: Array) -> Array:
        """y at a depth, odd: below zero depth it pulls, so that a force ends by crossing zero."""
        pressed = self.curve.force(np.abs(depth) * self.scales.depth) / self.scales.load
        return np.asarray(np.sign(depth) * pressed)

    def load_slope(self, depth: Array) -> Array:
        """dy/d depth."""
        slope = self.curve.dforce_ddepth(np.abs(depth) * self.scales.depth)
        return np.asarray(slope * self.scales.depth / self.scales.load)

    def contact_radius(self, depth: Array) -> Array:
        """Contact radius of the elastic load curve, m."""
        return np.asarray(self.curve.contact_radius(depth * self.scales.depth))

    def start(self) -> Array:
        """State at touch: depth, velocity, work done, memories z_k of the load, memories x_k of the depth."""
        return np.concatenate([[0.0, 1.0, 0.0], np.zeros(2 * self.terms)])

    def force(self, state: Array) -> Array:
        """Force of states of shape (3 + 2K, ...)."""
        memory = self.stiffnesses @ state[3 : 3 + self.terms]
        viscous = self.modulus.viscosity * self.load_slope(state[0]) * state[1]
        return np.asarray(self.modulus.equilibrium * self.load(state[0]) + memory + viscous)

    def rate(self, state: Array) -> Array:
        """Time derivative of one state, shape (3 + 2K,)."""
        force, k = self.force(state), self.terms
        depth, velocity = state[0], state[1]
        change = np.empty_like(state)
        change[0] = velocity
        change[1] = self.gravity - force
        change[2] = force * velocity
        change[3 : 3 + k] = self.load_slope(depth) * velocity - state[3 : 3 + k] * self.rates
        change[3 + k :] = velocity - state[3 + k :] * self.rates
        return change

    def stiffest(self, contact_radius: float) -> float:
        """The fastest rate of decay in the equations at this contact radius, m, in 1/T."""
        viscous = 2.0 * contact_radius * self.scales.depth / self.scales.load * self.modulus.viscosity
        return float(max([viscous, *self.rates]))
