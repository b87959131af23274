"""The deformable ball as a body that moves: free, meshed whole, finest where it is touched first."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sparse

import meshes
from fe_contact.assembly.cache import kept
from fe_contact.assembly.forms import Array, Indices, Matrix, isotropic, mass, stiffness, vector_dofs
from fe_contact.assembly.operators import basis_on, made
from fe_contact.assembly.surface import Surface, crown
from fe_contact.assembly.trace import contact_quadrature, trace_between
from fe_contact.bodies.zone import WIDEST
from fe_contact.dynamics.body import Part
from fe_contact.dynamics.mass.base import MASSES
from fe_contact.settings import WaveNumerics
from fe_contact.waves.half_space_body import SMALLEST
from fe_contact.waves.sides import WaveSide
from lumped.materials import Material


@dataclass(frozen=True, eq=False)
class UnitBall:
    """Matrices for radius, contact modulus and density one, sparse (n, n), without what the axis holds.

    ``free``: those of two degrees of freedom a node that the matrices have; ``surface`` by angles from the pole.
    """

    stiffness: Matrix
    mass: Matrix
    free: Indices
    surface: Surface
    order: int

    @property
    def axial(self) -> Array:
        """(n,): one for displacements along the axis, zero across."""
        return np.asarray(self.free % 2, dtype=np.float64)

    @property
    def volume(self) -> float:
        """Of the mesh."""
        return float(self.axial @ (self.mass @ self.axial))

    @property
    def quadrature(self) -> tuple[Array, Array]:
        """Angles where it may be touched, rad, and their area seen along the axis, each (q,)."""
        points, lengths, _ = contact_quadrature(self._corners(self.surface.zone), self.order)
        return points, lengths * self.surface.measure(points)

    def seen(self, angles: Array) -> tuple[Matrix, Array]:
        """Nodal forces of unit forces on the surface nodes that points (q,) see, and the trace there, (q, m)."""
        trace = trace_between(self._corners(float(angles.max())), angles, self.order)
        m = trace.shape[1]
        rows = np.searchsorted(self.free, 2 * self.surface.dofs[:m] + 1)
        return sparse.csc_matrix((-np.ones(m), (rows, np.arange(m))), shape=(self.free.size, m)), trace

    def _corners(self, end: float) -> Array:
        """Of whole facets, up to an angle at least."""
        corners = self.surface.coordinate[:: self.order]
        return corners[: np.searchsorted(corners, end) + 1]


@dataclass(frozen=True)
class Ball:
    """Radius, m, material, and mass, kg, which its density gives way to."""

    radius: float
    material: Material
    mass: float

    def points(self, numerics: WaveNumerics) -> tuple[Array, Array]:
        """Where it may be touched, m from the axis, and the areas seen along it, m2, each (q,)."""
        angles, weights = self._unit(numerics).quadrature
        return self.radius * np.sin(angles), self.radius**2 * weights

    def side(self, numerics: WaveNumerics, places: Array) -> WaveSide:
        """In SI units, under points, m from the axis."""
        unit, modulus = self._unit(numerics), self.material.contact_modulus()
        push, trace = unit.seen(np.arcsin(np.minimum(places / self.radius, 1.0)))
        part = Part(self.radius * unit.stiffness, modulus)
        return WaveSide(self.mass / unit.volume * unit.mass, (part,), None, push, trace, unit.axial)

    def _unit(self, numerics: WaveNumerics) -> UnitBall:
        contact = min(float(np.arcsin(min(numerics.contact_radius / self.radius, 1.0))), WIDEST)
        elements = numerics.elements_per_contact * numerics.finer
        return unit_ball(self.material.nu, elements, numerics.order, contact, numerics.mass)


@kept
def unit_ball(poisson: float, elements: float, order: int, contact: float, masses: str) -> UnitBall:
    """Mesh and assemble; made once for all steps and penalties."""
    basis = basis_on(made(meshes.sphere, elements, SMALLEST, contact, order), order)
    surface = crown(basis, contact, 0.0)
    free = np.setdiff1d(np.arange(2 * basis.N), 2 * basis.get_dofs("axis").flatten())
    inertia = MASSES.get(masses).of(mass(basis), vector_dofs(basis.element_dofs), 2 * basis.N, 2 * surface.dofs + 1)
    springs = stiffness(basis, isotropic(1 - poisson**2, poisson))
    return UnitBall(springs.tocsc()[free][:, free], inertia.tocsc()[free][:, free], free, surface, order)
