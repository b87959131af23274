"""A body that nothing holds: its own uniform acceleration balances the load, its centre of mass is the datum."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_contact.assembly.forms import Array, Basis


@dataclass(frozen=True, eq=False)
class Floating:
    """``mass`` (2 N,): what every axial degree of freedom carries of the body's mass, zero for the others."""

    mass: Array

    @classmethod
    def of(cls, basis: Basis, weight: Array) -> Floating:
        """Of a uniform body; ``weight`` (elements, points): volume of every quadrature point of the basis."""
        mass = np.zeros(2 * basis.N)
        for local, shape in enumerate(basis.basis):
            np.add.at(mass, 2 * basis.element_dofs[local] + 1, (np.asarray(shape[0]) * weight).sum(axis=1))
        return cls(mass)

    def balanced(self, load: Array) -> Array:
        """A load (2 N,) or loads (2 N, n) with the inertia against it, so that no resultant is left."""
        share = load[1::2].sum(axis=0) / self.mass.sum()
        return np.asarray(load - np.multiply.outer(self.mass, share))

    def centred(self, displacement: Array) -> Array:
        """Displacements (2 N,) or (2 N, n) relative to the centre of mass."""
        found = displacement.copy()
        found[1::2] -= self.mass @ displacement / self.mass.sum()
        return found
