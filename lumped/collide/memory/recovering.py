"""Recovering: out of contact the surface creeps back freely; the bodies meet where it then stands."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lumped.collide.bodies import Bodies, State
from lumped.collide.flight import bisected, flown
from lumped.collide.hereditary import HereditaryLoad
from lumped.materials import Relaxation

Array = NDArray[np.float64]


def returned(load: HereditaryLoad, bodies: Bodies, last: State) -> tuple[float, State] | None:
    """They meet after the top of the flight, when the load y of the depth is that of the free surface."""
    if bodies.gravity <= 0.0:
        return None
    top = -last.rate / bodies.gravity
    surface = FreeSurface.of(load, last)

    def apart(time: float) -> bool:
        depth = flown(last, bodies.gravity, time).depth
        return depth <= 0.0 or bool(load.load(depth) < surface.at(time)[0])

    time = bisected(apart, top, 2.0 * top)
    memory = tuple(surface.at(time)[1:].tolist())
    return time, flown(last, bodies.gravity, time)._replace(memory=memory)


class FreeSurface:
    """A surface without force: E_glassy y + eta y' = sum E_k w_k, w_k' = (y - w_k)/tau_k; linear, so exponentials."""

    def __init__(self, rates: Array, modes: Array, weights: Array) -> None:
        self._rates, self._modes, self._weights = rates, modes, weights

    @classmethod
    def of(cls, load: HereditaryLoad, last: State) -> FreeSurface:
        """From the end of a contact on."""
        modulus, memory = load.modulus, np.array(last.memory)
        moduli = np.array(modulus.moduli)
        standing = float(load.load(last.depth))
        if modulus.viscosity == 0.0:
            standing = float(moduli @ memory) / modulus.glassy
        rates, modes = np.linalg.eig(_matrix(modulus))
        return cls(rates, modes, np.linalg.solve(modes, np.array([standing, *memory])))

    def at(self, time: float) -> Array:
        """y and the memories w_k, shape (1 + K,), m2."""
        return np.real(self._modes @ (self._weights * np.exp(self._rates * time)))


def _matrix(modulus: Relaxation) -> Array:
    """d/dt of (y, w_1 ... w_K)."""
    moduli, times = np.array(modulus.moduli), np.array(modulus.times)
    matrix = np.zeros((1 + moduli.size, 1 + moduli.size))
    matrix[1:, 0] = 1.0 / times
    matrix[1:, 1:] = -np.diag(1.0 / times)
    if modulus.viscosity > 0.0:
        matrix[0] = np.concatenate([[-modulus.glassy], moduli]) / modulus.viscosity
    else:
        matrix[0] = moduli @ matrix[1:] / modulus.glassy
    return matrix
