"""What is left of a strain once nothing presses any more: the free recovery of a material that remembers.

With the strain u(0), the strains y_k of the dashpots in the branches and no stress from then on, the transforms of
E_inf u + sum_k E_k z_k + eta u' = 0 and z_k = u - y_k, z_k' = u' - z_k/tau_k, give

    u(s) = sJ(s) N(s) ,    N(s) = sum_k E_k tau_k y_k(0)/(1 + s tau_k) + eta u(0) ,

with the creep compliance J. The poles of N are zeros of sJ(s), so that the poles of the creep alone are left: one
exponential a retardation time, and for a fluid what stays. Whatever springs hold at first is let go at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lumped.errors import BadInput, Fault
from lumped.materials.relaxation import Relaxation

Array = NDArray[np.float64]
HALVINGS = 2000  # of the longest time, enough for the shortest a number can be


@dataclass(frozen=True)
class Recovery:
    """u(t) = permanent + sum_k amplitudes_k exp(-t/times_k), in the unit of the strain; times in s."""

    permanent: float
    amplitudes: tuple[float, ...] = ()
    times: tuple[float, ...] = ()

    @classmethod
    def of(cls, relaxation: Relaxation, strain: float, dashpots: Sequence[float] | Array) -> Recovery:
        """From the strain (told by a viscosity alone) and those of the branches' dashpots, (k,), all in one unit."""
        creep = relaxation.creep()
        branches = np.array([relaxation.moduli, relaxation.times, dashpots], dtype=float)
        moduli, taus, flowed = branches[:, branches[0] > 0.0]
        pulls = moduli * taus * flowed
        damped = relaxation.viscosity * strain
        retardation = np.array(creep.times)
        answers = np.array(creep.compliances) / retardation
        apart = 1.0 - taus / retardation[:, None]
        # a branch too weak to tell retardation from relaxation holds nothing back
        released = np.divide(pulls, apart, out=np.zeros_like(apart), where=apart != 0.0).sum(axis=1) + damped
        stays = creep.fluidity * (float(pulls.sum()) + damped)
        return cls(stays, tuple((answers * released).tolist()), creep.times)

    def __call__(self, time: ArrayLike) -> Array:
        """What is left at times >= 0, s, of any shape."""
        t = np.asarray(time, dtype=float)
        value = np.full(t.shape, self.permanent)
        for amplitude, tau in zip(self.amplitudes, self.times, strict=True):
            value = value + amplitude * np.exp(-t / tau)
        return value

    def until(self, share: float) -> float:
        """Time, s, at which a share of what goes is left; zero where nothing goes. Raises BadInput."""
        from scipy.optimize import brentq  # late: scenes and the spring row need numpy alone

        if not 0.0 < share < 1.0:
            raise BadInput(Fault("recovery", "share", f"{share:g}: accepted between 0 and 1"))
        goes = float(self(0.0)) - self.permanent
        if goes == 0.0:
            return 0.0
        most = float(np.abs(self.amplitudes).sum())
        last = (1.0 + np.log(most / (share * abs(goes)))) * max(self.times)

        def over(time: float) -> float:
            return (float(self(time)) - self.permanent) / goes - share

        return float(brentq(over, 0.0, last, xtol=float(np.finfo(float).tiny), rtol=1e-12, maxiter=HALVINGS))
