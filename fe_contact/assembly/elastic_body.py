"""A body with its mesh and its supports, for any isotropic material: a new Poisson's ratio needs no new mesh."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from fe_contact.assembly.floating import Floating
from fe_contact.assembly.forms import Basis, Indices, Matrix, elastic, plane_stiffness, stiffness
from fe_contact.assembly.operators import SurfaceOperator, condensed
from fe_contact.assembly.surface import Surface


@dataclass(frozen=True, eq=False)
class ElasticBody:
    """``basis`` scalar scikit-fem basis with N functions; ``stiffness`` sparse (2 N, 2 N), of bulk and shear modulus.

    ``fixed`` degrees of freedom held at zero; ``surface`` where contact may happen. What lies beyond the mesh is part
    of the stiffness, hence linear in both moduli too. ``floating``: of a body that nothing holds but its inertia.
    """

    basis: Basis
    stiffness: Callable[[float, float], Matrix]
    fixed: Indices
    surface: Surface
    floating: Floating | None = None

    def operator(self, poisson: float, factors: bool = False) -> SurfaceOperator:
        """What the contact surface knows of it with this Poisson's ratio, for E* = 1; see :func:`condensed`."""
        matrix = self.stiffness(*moduli(poisson)).tocsc()
        return condensed(self.basis, matrix, self.fixed, poisson, self.surface, floating=self.floating, factors=factors)


def axisymmetric(basis: Basis, bulk: float, shear: float) -> Matrix:
    """Stiffness of a body of revolution that ends with its mesh, sparse (2 N, 2 N)."""
    return stiffness(basis, elastic(bulk, shear))


def plane(basis: Basis, bulk: float, shear: float) -> Matrix:
    """The same in plane strain, both halves."""
    return plane_stiffness(basis, elastic(bulk, shear))


def moduli(poisson: float) -> tuple[float, float]:
    """Bulk and shear modulus for E* = 1, that is E = 1 - nu^2."""
    return (1.0 - poisson**2) / (3.0 * (1.0 - 2.0 * poisson)), 0.5 * (1.0 - poisson)
