"""One-dimensional waves in an elastic rod, seen from its struck end (d'Alembert).

The end moves with f' + g', f' of the wave that leaves and g' of the one that comes back, and is pressed with

    F = Z (f' - g'),    g'(t) = echo f'(t - delay),    Z = density c A = A sqrt(E density),

echo -1 of a held other end, 1 of a free one, 0 of a rod without an end. Graff, Wave Motion in Elastic Solids, ch. 2
(ISBN 978-0-486-66745-4).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.numbers.quadrature import gauss
from lumped.scene.scene import Scene
from lumped.targets.rod import Rod

Array = NDArray[np.float64]
GAUSS_POINTS = 24


@dataclass(frozen=True)
class Waves:
    """Impedance Z, N s/m; delay of the echo, there and back, s; echo; transit to the other end, s."""

    impedance: float
    echo: float
    transit: float

    @property
    def delay(self) -> float:
        """Time to the other end and back, s; infinite where nothing comes back."""
        return 2.0 * self.transit if self.echo else math.inf

    def arrivals(self, pieces: int, end: float) -> Array:
        """When so many pieces of a motion begin, s, (pieces,): at touch and with every echo, none after the end."""
        delay = self.delay if pieces > 1 else 0.0
        return np.asarray(np.minimum(delay * np.arange(pieces), end))

    @classmethod
    def of(cls, scene: Scene) -> Waves:
        """Of a scene whose target is an elastic rod."""
        rod, material = scene.target, scene.geometry.material
        assert isinstance(rod, Rod)
        modulus, density = material.uniaxial_modulus().relaxed, material.density or 0.0
        return cls(rod.impedance(modulus, density), rod.echo, rod.length * math.sqrt(density / modulus))

    def energies(self, leaving: Callable[[Array], Array], rows: Array) -> tuple[float, float]:
        """Energy in the rod, kinetic and elastic, at the last of the times ``rows``, and what left it, J.

        ``leaving`` f' over time (n,), smooth between two rows. A rod that echoes holds the waves of the last delay, an
        endless one those of the last transit: what is older has passed the length.
        """
        held = 2.0 * self.transit if self.echo else self.transit
        first = max(rows[-1] - held, 0.0)
        early, late = (np.unique(np.clip(rows, *ends)) for ends in ((0.0, first), (first, rows[-1])))
        inside = self._carried(leaving, late)
        return inside, 0.0 if self.echo else self._carried(leaving, early)

    def _carried(self, leaving: Callable[[Array], Array], rows: Array) -> float:
        """Z int f'^2 dt, by Gauss between the rows."""
        nodes, weights = gauss(GAUSS_POINTS)
        length = np.diff(rows)
        times = rows[:-1, None] + length[:, None] * nodes
        values = leaving(times.ravel()).reshape(times.shape)
        return float(self.impedance * np.sum(length[:, None] * weights * values**2))
