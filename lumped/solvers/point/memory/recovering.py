"""Recovering: out of contact the surface creeps back freely; the bodies meet where it then stands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.materials.relaxation import Recovery
from lumped.solvers.point.bodies import Bodies, State, bisected, flown
from lumped.solvers.point.memory.base import HereditaryLoad, MemoryRule

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


@dataclass(frozen=True)
class FreeSurface:
    """A surface without force, its load y recovering; the memories, (K,), m2, follow: w_k' = (y - w_k)/tau_k."""

    load: Recovery
    remembered: Array
    times: Array

    @classmethod
    def of(cls, load: HereditaryLoad, last: State) -> FreeSurface:
        """From the end of a contact on: memories of the load are what the dashpots of a strain y have yielded."""
        recovery = Recovery.of(load.modulus, float(load.load(last.depth)), last.memory)
        return cls(recovery, np.array(last.memory), np.array(load.modulus.times))

    def at(self, time: float) -> Array:
        """y and the memories w_k, shape (1 + K,), m2."""
        rates = 1.0 / self.times
        left = np.exp(-time * rates)
        memories = self.remembered * left + self.load.permanent * (1.0 - left)
        for amplitude, tau in zip(self.load.amplitudes, self.load.times, strict=True):
            # of two exponentials the slower one, and what the other fills of it
            apart, slower = np.abs(rates - 1.0 / tau), np.exp(-time * np.minimum(rates, 1.0 / tau))
            filled = np.divide(-np.expm1(-time * apart), apart, out=np.full_like(left, time), where=apart != 0.0)
            memories += amplitude * rates * slower * filled
        return np.append(self.load(time), memories)


MEMBER = MemoryRule(returned)
