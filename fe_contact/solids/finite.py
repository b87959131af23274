"""Large strains of a hyperelastic material."""

from __future__ import annotations

from dataclasses import dataclass

from fe_contact.assembly.forms import Array
from fe_contact.solids.base import PointAnswer, State
from lumped.materials.energies.base import Strained, StrainEnergy, strained


@dataclass(frozen=True)
class Hyperelastic:
    """An ``energy`` with these moduli of small strain, Pa: ``shear`` mu and ``lame`` lambda."""

    energy: StrainEnergy
    shear: float
    lame: float

    def respond(self, gradient: Array, state: State) -> PointAnswer:
        """See :class:`fe_contact.solids.base.Response`."""
        found = self.strained(gradient)
        return PointAnswer(found.stress, found.tangent, found.energy, (), found.pulls, found.drifts)

    def strained(self, gradient: Array) -> Strained:
        """What a displacement gradient (5, ...) makes of it."""
        return strained(self.energy, gradient, self.shear, self.lame)
