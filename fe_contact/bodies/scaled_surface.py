"""A homogeneous half-space seen through its surface, on a mesh that breathes with the contact.

The half-space has no length of its own: scaling the mesh by a contact radius ``a`` divides its compliance
by ``a`` and changes nothing else. So one operator, made for radius one, serves every instant, and the
contact edge always lies in the finest elements instead of anywhere in a coarse one. With the nodal forces
and the pressure in units of the unit mesh,

    displacement x modulus = C_unit forces / a ,   pressure = unit pressure / a ,   force = a sum(W p_unit).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fe_contact.contact import ContactProblem
from fe_contact.forms import Array
from fe_contact.operators import SurfaceOperator, monomials


@dataclass(frozen=True)
class ScaledSurface:
    """Contact surface of the half-space; ``operator`` is condensed for contact radius 1 and E* = 1."""

    operator: SurfaceOperator

    @cached_property
    def _with_striker(self) -> tuple[Array, Array]:
        """Stiffness and trace with one more unknown: the striker's yielding under the new force."""
        size = len(self.operator.stiffness)
        stiffness = np.zeros((size + 1, size + 1))
        stiffness[:size, :size] = self.operator.stiffness
        trace = np.column_stack([self.operator.trace, np.ones(len(self.operator.points))])
        return stiffness, trace

    def problem(self, overlap: Array, penalty: float, yielding: float) -> ContactProblem:
        """Contact problem on the unit mesh.

        Parameters
        ----------
        overlap : (q,) free overlap times modulus at the quadrature points.
        penalty : dimensionless penalty stiffness, in units of modulus over contact radius.
        yielding : striker's displacement times modulus per unit-mesh force; 0 holds it fixed.
        """
        operator = self.operator
        if yielding == 0.0:
            return ContactProblem(operator.stiffness, operator.trace, operator.weights, overlap, penalty)
        stiffness, trace = self._with_striker
        stiffness = stiffness.copy()
        stiffness[-1, -1] = 1 / yielding
        return ContactProblem(stiffness, trace, operator.weights, overlap, penalty)

    def response(self, pressure: Array) -> Array:
        """Displacement times modulus of all surface nodes, (n_s,), under a unit-mesh pressure (q,)."""
        operator = self.operator
        return operator.response @ (operator.trace.T @ (operator.weights * pressure))

    def sample(self, nodal: Array, radii: Array) -> Array:
        """Evaluate a nodal surface field at radii in units of the contact radius, outside the mesh as 1/r.

        Beyond the far radius the field is the point force's, which the far boundary condition stands for.
        """
        order, nodes = self.operator.order, self.operator.nodes
        corners = nodes[::order]
        values = np.stack([nodal[k : len(nodal) - order + k : order] for k in range(order)] + [nodal[order::order]])
        coefficients = monomials(order) @ values
        facet = np.minimum(np.searchsorted(corners, radii, side="right") - 1, len(corners) - 2)
        x = (radii - corners[facet]) / (corners[facet + 1] - corners[facet])
        field: Array = coefficients[order][facet]
        for power in range(order - 1, -1, -1):
            field = field * x + coefficients[power][facet]
        beyond = radii > corners[-1]
        field[beyond] = nodal[-1] * corners[-1] / radii[beyond]
        return field
