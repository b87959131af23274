"""A surface that nothing presses any more: what it remembers creeps back freely, and exactly.

With the strains y_k = u - z_k of the dashpots, no stress means

    E_inf u + sum_k E_k (u - y_k) + eta du/dt = 0 ,    tau_k dy_k/dt = u - y_k ,

of which the retardation times theta_j of the creep compliance are the only times, as in
:class:`lumped.materials.Recovery`. Each has one mode, u = 1 and y_k = theta_j/(theta_j - tau_k); modes share no heat.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.bodies.memory import SurfaceMemory, product
from lumped.materials import Relaxation


@dataclass(frozen=True, eq=False)
class Released:
    """What is left of a memory over the time since nothing presses, s.

    ``permanent`` (f, r) and ``amplitudes`` (j, f, r) of the displacement u, and of the pressure that would hold it
    elastically with unit modulus; ``times``, s, and ``compliances``, 1/Pa, (j,) of the creep; ``springs`` (k, j): z_k
    of a mode with u = 1.
    """

    areas: Array
    permanent: Array
    amplitudes: Array
    times: Array
    springs: Array
    compliances: Array

    @classmethod
    def of(cls, relaxation: Relaxation, memory: SurfaceMemory) -> Released:
        """From a memory, whose springs let go of what they still press with."""
        creep, moduli, taus = relaxation.creep(), np.array(relaxation.moduli), np.array(relaxation.times)
        kept = np.array(creep.compliances) > 0.0
        compliances, times = np.array(creep.compliances)[kept], np.array(creep.times)[kept]
        apart = 1.0 - taus[:, None] / times
        # a branch too weak to tell retardation from relaxation holds nothing back
        dashpots = np.divide(1.0, apart, out=np.zeros_like(apart), where=apart != 0.0)
        damped = relaxation.viscosity * memory.strain
        pulls = (moduli * taus)[:, None, None] * (memory.strain - memory.branches)
        released = np.tensordot(dashpots.T, pulls, 1) + damped
        amplitudes = (compliances / times)[:, None, None] * released
        permanent = creep.fluidity * (pulls.sum(axis=0) + damped)
        return cls(memory.areas, permanent, amplitudes, times, 1.0 - dashpots, compliances)

    def displacement(self, place: int, time: float) -> float:
        """At one place of the memory, m."""
        return float(self.permanent[0, place] + np.exp(-time / self.times) @ self.amplitudes[:, 0, place])

    def after(self, time: float) -> SurfaceMemory:
        """The memory after a time, s."""
        left = np.exp(-time / self.times)[:, None, None] * self.amplitudes
        return SurfaceMemory(self.areas, self.permanent + left.sum(axis=0), np.tensordot(self.springs, left, 1))

    def dissipated(self, time: float) -> float:
        """Heat of a time, s: of each mode what its springs held, theta/C (u p) / theta / 2; J."""
        gone = -np.expm1(-2.0 * time / self.times) / self.compliances
        held = np.array([product(self.areas, mode, mode) for mode in self.amplitudes])
        return 0.5 * float(gone @ held)
