"""A striker on a material with memory, without dimension."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lumped.load_curves import LoadCurve
from lumped.materials import Relaxation
from lumped.numbers import Array, Real

# A relative step for a difference, and a depth too small to matter.
NEARBY, TINY = 1e-6, 1e-150
NUMBERS = 5  # of a problem beside those of its terms
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
    def units(self) -> tuple[float, float]:
        """Of depth, m, and of load, m2."""
        return self.scales.depth, self.scales.load

    @cached_property
    def row(self) -> Array:
        """Its numbers: units, gravity, E_inf, viscosity; of every term modulus and rate, shape (5 + 2 K,)."""
        terms = np.stack([self.stiffnesses, self.rates], axis=1).ravel()
        return np.array([*self.units, self.gravity, self.modulus.equilibrium, self.modulus.viscosity, *terms])

    def loads(self, depth: Array) -> tuple[Array, Array]:
        """y and dy/d depth at a depth; y is odd: below zero it pulls, so that a force ends by crossing zero."""
        return _loads(self.curve, depth, *self.units)

    def contact_radius(self, depth: Array) -> Array:
        """Contact radius of the elastic load curve, m."""
        return np.asarray(self.curve.contact_radius(depth * self.scales.depth))

    @cached_property
    def rises_steeply(self) -> bool:
        """Whether the force at touch rises with a power of r = sqrt(t) that is no whole number.

        It does where a viscosity meets dy/d depth ~ depth^beta and 2 beta is none: profiles c r^n, n neither 1 nor 2.
        """
        return bool(self.modulus.viscosity) and abs(self.power - round(self.power)) > WHOLE

    @cached_property
    def power(self) -> float:
        """Of r that dy/d depth starts with, 2 beta."""
        _, (near, far) = self.loads(SHALLOW * np.array([1.0, 4.0]))
        return float(np.log2(far / near))

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


@dataclass(frozen=True, eq=False)
class Problems:
    """B problems of as many Prony terms K, all with viscosity, and weight, or none; their numbers, `rows` (B, 5 + 2 K).

    `which` (B,) says which of the `curves` each has: those in closed form are shared.
    """

    curves: Sequence[LoadCurve]
    which: NDArray[np.intp]
    rows: Array

    @classmethod
    def of(cls, problems: Sequence[Hereditary]) -> Problems:
        """Theirs."""
        curves, first = [one.curve for one in problems], dict[object, int]()
        which = np.array([first.setdefault(curve if curve.closed else i, i) for i, curve in enumerate(curves)])
        return cls(curves, which, np.array([one.row for one in problems]))

    def chosen(self, some: NDArray[np.bool_]) -> Problems:
        """Some of them."""
        return Problems(self.curves, self.which[some], self.rows[some])

    @property
    def gravity(self) -> Array:
        """(B, 1)."""
        return self.rows[:, 2:3]

    @property
    def equilibrium(self) -> Array:
        """E_inf, (B, 1)."""
        return self.rows[:, 3:4]

    @property
    def viscosity(self) -> Array:
        """(B, 1)."""
        return self.rows[:, 4:5]

    @property
    def viscous(self) -> bool:
        """Whether they have a viscosity."""
        return bool(self.rows[0, 4] > 0.0)

    @property
    def weighty(self) -> bool:
        """Whether there is gravity."""
        return bool(self.rows[0, 2] != 0.0)

    @property
    def stiffnesses(self) -> Array:
        """Moduli E_k, (B, K)."""
        return self.rows[:, NUMBERS::2]

    @property
    def rates(self) -> Array:
        """1/tau_k, (B, K)."""
        return self.rows[:, NUMBERS + 1 :: 2]

    def loads(self, depth: Array) -> tuple[Array, Array]:
        """As :meth:`Hereditary.loads`, of depths (B, n)."""
        deep, unit = self.rows[:, :1], self.rows[:, 1:2]
        if not (self.which - self.which[0]).any():
            return _loads(self.curves[self.which[0]], depth, deep, unit)
        load, slope = np.empty((2, *depth.shape))
        for i in np.unique(self.which).tolist():
            own = self.which == i
            load[own], slope[own] = _loads(self.curves[i], depth[own], deep[own], unit[own])
        return load, slope

    def bend(self, depth: Array, slope: Array) -> Array:
        """d2y/d depth2 by a difference, good for Newton's steps, of depths (B, n)."""
        step = NEARBY * depth + TINY
        return np.asarray((self.loads(depth + step)[1] - slope) / step)


def _loads(curve: LoadCurve, depth: Array, deep: Real, unit: Real) -> tuple[Array, Array]:
    """y and dy/d depth at depths in units `deep`, m; of a load in units of `unit`, m2."""
    force, slope = curve.force_and_slope(np.abs(depth) * deep)
    return np.copysign(force / unit, depth), np.asarray(slope * (deep / unit))
