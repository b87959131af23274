"""A striker on a material with memory, without dimension."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lumped.load_curves import LoadCurve
from lumped.materials import Relaxation
from lumped.numbers import Array

# A relative step for a difference, and a depth too small to matter.
NEARBY, TINY = 1e-6, 1e-150
# A share of the shortest contact time, to see how a load starts; a power is whole that is as near to a whole number.
SHALLOW, WHOLE = 1e-9, 1e-3


@dataclass(frozen=True)
class HereditaryScales:
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

    `modulus` is E*(t) in units of `scales.unit` and `scales.time`; `gravity` in v/T; `shortest` is the contact
    time on the stiffest answer of the material, in T. With z_k' = y' - z_k/tau_k the force is E_inf y + sum
    E_k z_k + eta y'.
    """

    scales: HereditaryScales
    curve: LoadCurve
    modulus: Relaxation
    gravity: float
    shortest: float

    @classmethod
    def of(
        cls,
        curve: LoadCurve,
        modulus: Relaxation,
        mass: float,
        velocity: float,
        gravity: float,
        time: float,
        shortest: float,
    ) -> Hereditary:
        """From values in SI; `time` is the unit of time, s."""
        unit = modulus.spring or modulus.viscosity / time
        taus = tuple(tau / time for tau in modulus.times)
        moduli = tuple(value / unit for value in modulus.moduli)
        plain = Relaxation(modulus.equilibrium / unit, moduli, taus, modulus.viscosity / (unit * time))
        scales = HereditaryScales(time, velocity, mass, unit)
        return cls(scales, curve, plain, gravity * time / velocity, shortest / time)

    @property
    def terms(self) -> int:
        """Number of Prony terms K."""
        return len(self.modulus.moduli)

    @cached_property
    def stiffnesses(self) -> Array:
        """Moduli E_k, shape (K,)."""
        return np.array(self.modulus.moduli)

    @cached_property
    def rates(self) -> Array:
        """1/tau_k, shape (K,)."""
        return 1.0 / np.array(self.modulus.times)

    @cached_property
    def springs(self) -> Array:
        """E_inf and the moduli E_k, shape (K + 1,)."""
        return np.array([self.modulus.equilibrium, *self.modulus.moduli])

    @cached_property
    def fadings(self) -> Array:
        """The rates of `springs`, which are those of the moduli and none for E_inf."""
        return np.array([0.0, *self.rates])

    @cached_property
    def _units(self) -> tuple[float, float]:
        """Of depth, m, and of load, m2."""
        return self.scales.depth, self.scales.load

    def loads(self, depth: Array) -> tuple[Array, Array]:
        """y and dy/d depth at a depth; y is odd: below zero it pulls, so that a force ends by crossing zero."""
        deep, load = self._units
        force, slope = self.curve.force_and_slope(np.abs(depth) * deep)
        return np.copysign(force / load, depth), np.asarray(slope * (deep / load))

    def bend(self, depth: Array, slope: Array) -> Array:
        """d2y/d depth2 by a difference, good for Newton's steps."""
        step = NEARBY * depth + TINY
        return np.asarray((self.loads(depth + step)[1] - slope) / step)

    def contact_radius(self, depth: Array) -> Array:
        """Contact radius of the elastic load curve, m."""
        return np.asarray(self.curve.contact_radius(depth * self.scales.depth))

    @cached_property
    def rises_steeply(self) -> bool:
        """Whether the force at touch rises with a power of r = sqrt(t) that is no whole number.

        It does where a viscosity meets dy/d depth ~ depth^beta and 2 beta is none: profiles c r^n, n neither 1 nor 2.
        """
        if not self.modulus.viscosity:
            return False
        _, (near, far) = self.loads(SHALLOW * np.array([1.0, 4.0]))
        power = float(np.log2(far / near))
        return abs(power - round(power)) > WHOLE

    def early(self, times: Array) -> Array:
        """States so soon after touch, times (n,), that the velocity is still that of touch; shape (4 + K, n).

        Depth, velocity, work done, force, memories z_k of the load.
        """
        load, slope = self.loads(times)
        states = np.empty((4 + self.terms, times.size))
        states[0], states[1] = times, 1.0
        states[2] = self.modulus.viscosity * load
        states[3] = self.modulus.glassy * load + self.modulus.viscosity * slope
        states[4:] = load
        return states
