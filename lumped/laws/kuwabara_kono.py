"""Kuwabara and Kono, Brilliantov and Poschel: F = k (depth^(3/2) + (3/2) A sqrt(depth) rate), a viscous sphere.

Doi 10.1143/JJAP.26.1230, doi 10.1103/PhysRevE.53.5382: a Kelvin-Voigt sphere whose relaxation is short beside the
contact. A in s. The force is that of Hertz at the depth which A later would be reached, to first order. With
`exit = "depth"` the damper pulls at the end. The restitution falls with the fifth root of the velocity.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from lumped.laws._parameters import COMMON, RESTITUTION, STIFFNESS, Parameters, damping_key, formula_key
from lumped.laws._power_law import PowerLaw
from lumped.laws.base import LawKind
from lumped.numbers import Real
from lumped.scene.scene import Scene
from lumped.solvers.point.bodies import Stage


@dataclass(frozen=True, kw_only=True)
class KuwabaraKono(PowerLaw):
    """The law with k, N/m^(3/2), and A, s."""

    A: float
    alpha: float = 1.5
    name: ClassVar[str] = "kuwabara_kono"
    tensile: ClassVar[bool] = True

    def exponents(self, stage: Stage) -> tuple[float, ...]:
        """The spring's and the damper's."""
        return (1.5, 0.5)

    def damper(self, depth: Real, rate: Real, stage: Stage) -> Real:
        """(3/2) A k sqrt(depth) rate."""
        return 1.5 * self.A * self.k * np.sqrt(depth) * rate

    def damper_tangents(self, depth: Real, rate: Real, stage: Stage) -> tuple[Real, Real]:
        """Its slopes."""
        strength, root = 1.5 * self.A * self.k, np.sqrt(depth)
        return 0.5 * strength * rate / root, strength * root


def of(scene: Scene) -> KuwabaraKono:
    """The law for a scene. Raises BadInput.

    The damping of :mod:`lumped.restitution.kuwabara_kono` is x = (3/2) A (k/m)^(2/5) v^(1/5).
    """
    given = Parameters(scene, KuwabaraKono.name)
    k = given.stiffness(1.5)
    kind, A = given.damping(("A",))
    if kind == "e":
        A = given.meeting("kuwabara_kono", A) / (1.5 * (k / scene.reduced_mass) ** 0.4 * scene.velocity**0.2)
    return KuwabaraKono(k=k, A=A, **given.common())


MEMBER = LawKind(of, __doc__, (STIFFNESS, RESTITUTION, damping_key("A", "s"), formula_key("kuwabara_kono"), COMMON))
