"""Small strains of a material that yields."""

from __future__ import annotations

from dataclasses import dataclass

from fe_contact.assembly.forms import Array
from fe_contact.solids.base import PointAnswer, State
from lumped.materials.plasticity import Yielding


@dataclass(frozen=True)
class Plastic:
    """A material that flows; its points remember plastic strain (4, ...) and its amount (...)."""

    material: Yielding

    def respond(self, gradient: Array, state: State) -> PointAnswer:
        """See :class:`fe_contact.solids.base.Response`."""
        found = self.material.flowed(gradient, *state)
        return PointAnswer(found.stress, found.tangent, found.energy, (found.strain, found.amount))
