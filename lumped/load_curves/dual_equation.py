"""The layer's dual integral equation, reduced to Fredholm's of the second kind and solved by Nystrom's method.

With x, s, t in thicknesses, phi the pressure's Abel transform and g the one-dimensional profile of the indenter,
    phi(t) - int_0^ratio k(s, t) phi(s) ds = depth - g(t),  k(s, t) = (2/pi) int_0^inf (1-L(u)) cos(us) cos(ut) du,
    F/E* = 2 thickness int_0^ratio phi dt,  phi(ratio) = 0 where the profile leaves the surface smoothly.
L = 1 leaves phi = depth - g: the half-space. Lebedev and Ufliand 1958, J. Appl. Math.
Mech. 22, 442-450.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from lumped.load_curves.layer import Array, deficit, waves
from lumped.numbers.quadrature import gauss


@dataclass(frozen=True)
class DualEquation:
    """The equation of one layer at one contact radius, `ratio` thicknesses. Lengths count in thicknesses."""

    nu: float
    base: str
    ratio: float
    refinement: float = 1.0

    @cached_property
    def nodes(self) -> Array:
        """Places t, shape (n,), crowded at both ends: powers of t and the logarithm of a sphere's rim are met there."""
        return self.ratio * np.sin(0.5 * np.pi * self._rule[0]) ** 2

    @cached_property
    def weights(self) -> Array:
        """Weights of the integral over t, shape (n,)."""
        return self.ratio * 0.5 * np.pi * np.sin(np.pi * self._rule[0]) * self._rule[1]

    @cached_property
    def punch(self) -> Array:
        """phi of a flat punch at unit depth, shape (n,)."""
        return self.answer(np.ones_like(self.nodes))

    @cached_property
    def edge(self) -> Array:
        """What a unit of source at each node adds to phi at the edge, shape (n,), weights apart."""
        return self.answer(self._kernel_at(np.array([self.ratio]))[0])

    def answer(self, source: Array) -> Array:
        """phi at the nodes for the right-hand side at the nodes, both of shape (n,)."""
        matrix = np.eye(self.nodes.size) - self._kernel_at(self.nodes) * self.weights
        return np.asarray(np.linalg.solve(matrix, source))

    def correction_slope(self, phi: Array, t: Array) -> Array:
        """phi'(t) less the slope of its source, at any t; shapes (n,), (...) and (...)."""
        u, density = self._spectrum
        spectrum = -u * density * ((self.weights * phi) @ np.cos(np.multiply.outer(self.nodes, u)))
        return np.asarray(np.sin(np.multiply.outer(t, u)) @ spectrum)

    @property
    def _rule(self) -> tuple[Array, Array]:
        return gauss(int(self.refinement * (32.0 + 6.0 * self.ratio)))

    @cached_property
    def _spectrum(self) -> tuple[Array, Array]:
        """Wavenumbers and (2/pi) (1-L) du."""
        u, weights = waves(self.ratio, self.refinement)
        return u, 2.0 / np.pi * weights * deficit(self.nu, self.base, u)

    def _kernel_at(self, t: Array) -> Array:
        """k(s, t) for s at the nodes, shape (m, n)."""
        u, density = self._spectrum
        return np.asarray((np.cos(np.outer(t, u)) * density) @ np.cos(np.outer(u, self.nodes)))


@lru_cache(maxsize=1024)
def dual_equation(nu: float, base: str, ratio: float, refinement: float = 1.0) -> DualEquation:
    """The equation, with what it has already answered."""
    return DualEquation(nu, base, ratio, refinement)
