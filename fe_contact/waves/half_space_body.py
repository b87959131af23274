"""The half-space as a body that moves: a quarter disc so large that no echo returns, dashpots and springs beyond it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy.sparse as sparse
from skfem import FacetBasis

import meshes
from fe_contact.assembly import absorbing
from fe_contact.assembly.forms import Array, Basis, Indices, Matrix, mass, vector_dofs
from fe_contact.assembly.operators import basis_on, made, system_matrix
from fe_contact.assembly.surface import flat
from fe_contact.assembly.trace import contact_quadrature
from fe_contact.dynamics.body import BodyWithMass, Part, Pressing
from fe_contact.dynamics.mass.base import MASSES
from fe_contact.settings import WaveNumerics
from fe_contact.waves.moving import Moving, with_striker
from lumped.scene.scene import Scene

SMALLEST = 0.1  # contact radius over the largest one down to which every contact is resolved alike
BEYOND = 1e3  # height, in contact radii, given to radii past the striker's rim


@dataclass(frozen=True, eq=False)
class UnitBody:
    """Matrices for contact radius, E* and density one, sparse (N, N), the striker last; ``push`` and the points.

    ``basis``: scalar scikit-fem basis; ``free``: those of its degrees of freedom, two a node, that the matrices have.
    """

    basis: Basis
    free: Indices

    stiffness: Matrix
    mass: Matrix
    dashpots: Matrix
    push: Matrix
    trace: Array
    points: Array
    weights: Array


def moving(scene: Scene, numerics: WaveNumerics) -> Moving:
    """The half-space of a scene at first touch, in SI units."""
    material, modulus, a = scene.geometry.material, scene.contact_modulus, numerics.contact_radius
    unit = unit_of(scene, numerics)
    density = material.density or 0.0
    rigid, gravity = np.zeros(unit.mass.shape[0]), np.zeros(unit.mass.shape[0])
    rigid[-1], gravity[-1] = scene.reduced_mass, scene.gravity
    heights = np.minimum(scene.profile.height(a * unit.points), BEYOND * a)
    # a dashpot in parallel has no wave speed of its own
    impedance = None if modulus.viscosity else (a**2 * np.sqrt(modulus.glassy * density)) * unit.dashpots
    body = BodyWithMass(
        mass=density * a**3 * unit.mass,
        rigid=rigid,
        parts=(Part(a * unit.stiffness, modulus),),
        dashpots=impedance,
        gravity=gravity,
        pressing=Pressing(unit.push, unit.trace, a**2 * unit.weights, -heights),
    )
    return Moving(body, scene.velocity, a * unit.points, endless=True)


def unit_of(scene: Scene, numerics: WaveNumerics) -> UnitBody:
    """The body of unit size that a scene's is scaled from."""
    nu = scene.geometry.material.nu
    size = (numerics.elements_per_contact, numerics.finer, numerics.far_radius)
    return unit_body(nu, size, numerics.order, numerics.mass)


@lru_cache(maxsize=8)
def unit_body(poisson: float, size: tuple[float, float, float], order: int, masses: str) -> UnitBody:
    """Mesh and assemble; made once for all steps and penalties. ``size``: elements, how much finer, far radius."""
    elements, finer, far_radius = size
    basis = basis_on(made(meshes.half_space_for_waves, elements, SMALLEST, far_radius, finer), order)
    surface = flat(basis)
    far = FacetBasis(basis.mesh, basis.elem, facets=basis.mesh.boundaries["far"], intorder=2 * order + 4)
    free = np.setdiff1d(np.arange(2 * basis.N), 2 * basis.get_dofs("axis").flatten())
    corners = surface.coordinate[::order]
    zone = corners[: np.searchsorted(corners, surface.zone) + 1]  # whole facets only
    points, lengths, trace = contact_quadrature(zone, order)
    normal = 2 * surface.dofs + 1
    inertia = MASSES.get(masses).of(mass(basis), vector_dofs(basis.element_dofs), 2 * basis.N, normal)
    return UnitBody(
        basis=basis,
        free=free,
        stiffness=with_striker(system_matrix(basis, poisson), free),
        mass=with_striker(inertia, free),
        dashpots=with_striker(absorbing.dashpots(far, poisson), free),
        push=pushing(np.searchsorted(free, normal[: trace.shape[1]]), len(free)),
        trace=np.hstack([trace, np.ones((len(points), 1))]),
        points=points,
        weights=lengths * surface.measure(points),
    )


def pushing(touched: Indices, striker: int) -> sparse.csc_matrix:
    """Pressure pushes the surface into the body, z < 0, and the striker out of it."""
    rows = np.append(touched, striker)
    return sparse.csc_matrix((-np.ones(rows.size), (rows, np.arange(rows.size))), shape=(striker + 1, rows.size))
