"""A homogeneous half-space seen through its surface, on a mesh that breathes with the contact.

The half-space has no length of its own: scaling the mesh by a contact radius ``a`` divides its compliance
by ``a`` and changes nothing else. So one operator, made for radius one, serves every instant, and the
contact edge always lies in the finest elements instead of anywhere in a coarse one. With the nodal forces
and the pressure in units of the unit mesh,

    displacement x modulus = C_unit forces / a ,   pressure = unit pressure / a ,   force = a sum(W p_unit).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import SurfaceOperator
from fe_contact.assembly.pressed_surface import PressedSurface
from fe_contact.assembly.trace import monomials
from fe_contact.bodies.surface_body import SurfaceBody
from fe_contact.contact.problem import ContactProblem
from fe_contact.schemes.base import MemoryScheme
from fe_contact.settings import Numerics
from fe_contact.steppers.march import Snapshot, Strike
from fe_contact.steppers.stepping import Stepper
from fe_contact.steppers.steps import Stepping
from fe_contact.steppers.struck import Deformable
from lumped.materials import Relaxation


@dataclass(frozen=True)
class ScaledSurface(Deformable):
    """Contact surface of the half-space; ``operator`` is condensed for contact radius 1 and E* = 1.

    ``breathes``: whether the mesh follows the contact; where it stays, the same points seldom touch twice.
    """

    operator: SurfaceOperator
    breathes: bool = True

    def stepper(self, strike: Strike, numerics: Numerics, expected: Sequence[float] | Array) -> Stepping:
        """Steps on the mesh that follows the contact, or that stays."""
        if self.breathes:
            return Stepper(strike, self, numerics, expected)
        return super().stepper(strike, numerics, expected)

    def body(self, relaxation: Relaxation, scheme: MemoryScheme, scale: float) -> SurfaceBody:
        """The body on a mesh that stays, of unit length ``scale``, m: contact modulus E*(t), Pa, and time scheme."""
        return SurfaceBody(self.operator, self.pressed, relaxation, scheme, scale)

    @cached_property
    def pressed(self) -> PressedSurface:
        """What contact knows of it: one object, since the answers to a surface are kept by its identity."""
        operator = self.operator
        return PressedSurface(operator.stiffness, operator.trace, operator.weights, self.breathes)

    def felt(self, snapshot: Snapshot) -> tuple[Array, Array]:
        """Where the mesh follows the contact, what the snapshot says: it has no roughness to be freed of."""
        return (snapshot.radii, snapshot.pressure) if self.breathes else super().felt(snapshot)

    def problem(self, overlap: Array, penalty: float, yielding: float | Array) -> ContactProblem:
        """Contact problem on the unit mesh.

        Parameters
        ----------
        overlap : (q,) free overlap times modulus at the quadrature points.
        penalty : dimensionless penalty stiffness, in units of modulus over contact radius.
        yielding : striker's displacement times modulus per unit-mesh force; 0 holds it fixed, (q,) counts by place.
        """
        return ContactProblem(self.pressed, overlap, penalty, yielding)

    def response(self, pressure: Array) -> Array:
        """Displacement times modulus of all surface nodes, (n_s,), under a unit-mesh pressure (q,)."""
        operator = self.operator
        return operator.response @ (operator.trace.T @ (operator.weights * pressure))

    def sample(self, nodal: Array, radii: Array) -> Array:
        """Evaluate a nodal surface field at increasing radii in units of the contact radius, outside the mesh as 1/r.

        Beyond the far radius the field is the point force's, which the far boundary condition stands for.
        """
        corners, places, members = self._facets
        ends = radii.searchsorted(corners)
        ends[0] = 0
        reach = ends[-1]
        table = np.concatenate([places, monomials(self.operator.order) @ nodal[members]])
        start, stretch, *coefficients, field = np.repeat(table, ends[1:] - ends[:-1], axis=1)
        x = (radii[:reach] - start) * stretch
        for coefficient in reversed(coefficients):
            field *= x
            field += coefficient
        return np.concatenate([field, nodal[-1] * corners[-1] / radii[reach:]])

    @cached_property
    def _facets(self) -> tuple[Array, Array, npt.NDArray[np.intp]]:
        """Corners (f + 1,) of the surface's facets; where each starts and one over its length, (2, f); its nodes."""
        order, nodes = self.operator.order, self.operator.nodes
        corners = nodes[::order]
        members = np.arange(order + 1)[:, None] + order * np.arange(len(corners) - 1)
        return corners, np.stack([corners[:-1], 1 / np.diff(corners)]), members
