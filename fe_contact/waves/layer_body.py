"""The layer as a body that moves: so wide that no echo returns from its side, dashpots there; its base echoes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from skfem import FacetBasis

import meshes
from fe_contact.assembly.elastic_body import moduli
from fe_contact.assembly.far_field import on_boundary
from fe_contact.assembly.forms import Array, Basis, Indices, Matrix, mass, plane_mass, vector_dofs
from fe_contact.assembly.operators import basis_on, made
from fe_contact.assembly.surface import flat
from fe_contact.assembly.trace import contact_quadrature
from fe_contact.bodies.zone import held, thickness_over
from fe_contact.dynamics.body import BodyWithMass, Part, Pressing
from fe_contact.dynamics.mass.base import MASSES
from fe_contact.settings import WaveNumerics
from fe_contact.targets.layer import matrix
from fe_contact.waves.half_space_body import BEYOND, SMALLEST, pushing
from fe_contact.waves.moving import Moving, with_striker
from lumped.materials import Material, Relaxation
from lumped.scene.scene import Scene
from lumped.targets.layer import Layer


@dataclass(frozen=True, eq=False)
class UnitLayer:
    """Matrices for contact radius one, sparse (N, N), the striker last; ``push`` and the points.

    ``volume`` and ``shape``: stiffness of unit bulk and of unit shear modulus; ``mass`` of unit density; ``leaving``
    and ``sliding``: dashpots of unit impedance on the side, against motion through it and along it. ``basis``,
    ``free`` as of :class:`~fe_contact.waves.half_space_body.UnitBody`.
    """

    basis: Basis
    free: Indices

    volume: Matrix
    shape: Matrix
    mass: Matrix
    leaving: Matrix
    sliding: Matrix
    push: Matrix
    trace: Array
    points: Array
    weights: Array


def moving(scene: Scene, numerics: WaveNumerics) -> Moving:
    """The layer of a scene at first touch, in SI units; in plane strain all of its length. Raises BodyTooThin."""
    unit, a, total = unit_of(scene, numerics), numerics.contact_radius, scene.geometry.shape.total
    plane = 1 if scene.geometry.shape.plane else 0  # a dimension less to scale by
    rigid, gravity = np.zeros(unit.mass.shape[0]), np.zeros(unit.mass.shape[0])
    rigid[-1], gravity[-1] = scene.reduced_mass, scene.gravity
    heights = np.minimum(scene.profile.height(a * unit.points), BEYOND * a)
    body = BodyWithMass(
        mass=(scene.geometry.material.density or 0.0) * total * a ** (3 - plane) * unit.mass,
        rigid=rigid,
        parts=_parts(scene, unit, total * a ** (1 - plane)),
        dashpots=_dashpots(scene, unit, total * a ** (2 - plane)),
        gravity=gravity,
        pressing=Pressing(unit.push, unit.trace, total * a ** (2 - plane) * unit.weights, -heights),
    )
    return Moving(body, scene.velocity, a * unit.points, endless=True)


def unit_of(scene: Scene, numerics: WaveNumerics) -> UnitLayer:
    """The layer of unit contact radius that a scene's is scaled from; one serves every material."""
    target = scene.target
    assert isinstance(target, Layer)
    thickness = thickness_over(numerics.contact_radius, target.thickness)
    sizes = (numerics.elements_per_contact, numerics.finer, thickness, numerics.far_radius)
    return unit_layer(sizes, numerics.order, target.base == "bonded", scene.geometry.shape.plane, numerics.mass)


@lru_cache(maxsize=8)
def unit_layer(
    sizes: tuple[float, float, float, float], order: int, bonded: bool, plane: bool, masses: str
) -> UnitLayer:
    """Mesh and assemble; made once for all steps and penalties.

    ``sizes``: elements, how much finer they are at the surface, thickness, far radius.
    """
    elements, finer, thickness, far_radius = sizes
    basis = basis_on(made(meshes.layer_for_waves, elements, SMALLEST, thickness, far_radius - 1.0, finer), order)
    surface = flat(basis, 2 if plane else 3)
    fixed = held(basis, along=("axis", "base") if bonded else ("axis",), across=("base",))
    free = np.setdiff1d(np.arange(2 * basis.N), fixed)
    corners = surface.coordinate[::order]
    zone = corners[: np.searchsorted(corners, surface.zone) + 1]  # whole facets only
    points, lengths, trace = contact_quadrature(zone, order)
    normal = 2 * surface.dofs + 1
    local = plane_mass(basis) if plane else mass(basis)
    inertia = MASSES.get(masses).of(local, vector_dofs(basis.element_dofs), 2 * basis.N, normal)
    return UnitLayer(
        basis=basis,
        free=free,
        volume=with_striker(matrix(basis, bonded, plane, 1.0, 0.0), free),
        shape=with_striker(matrix(basis, bonded, plane, 0.0, 1.0), free),
        mass=with_striker(inertia, free),
        leaving=with_striker(_side(basis, plane, 0), free),
        sliding=with_striker(_side(basis, plane, 1), free),
        push=pushing(np.searchsorted(free, normal[: trace.shape[1]]), len(free)),
        trace=np.hstack([trace, np.ones((len(points), 1))]),
        points=points,
        weights=lengths * surface.measure(points),
    )


def _side(basis: Basis, plane: bool, component: int) -> Matrix:
    """Unit impedance of one component of the motion on the side, sparse (2 N, 2 N)."""
    facets = FacetBasis(basis.mesh, basis.elem, facets=basis.mesh.boundaries["side"], intorder=2 * basis.elem.maxdeg)
    radius = np.asarray(facets.global_coordinates())[0]
    tensor = np.zeros((2, 2, *radius.shape))
    tensor[component, component] = 1.0
    return on_boundary(facets, tensor, 2.0 if plane else 2 * np.pi * radius)


def _parts(scene: Scene, unit: UnitLayer, scale: float) -> tuple[Part, ...]:
    """Where nu stays one modulus tells all, else volume and shape relax apart."""
    material = scene.geometry.material
    if scene.geometry.surface_remembers:
        bulk, shear = moduli(material.nu)  # of E* = 1
        return (Part(scale * (bulk * unit.volume + shear * unit.shape), material.contact_modulus()),)
    volume, shape = Relaxation(material.bulk), material.shear
    return Part(scale * unit.volume, volume), Part(scale * unit.shape, shape)


def _dashpots(scene: Scene, unit: UnitLayer, scale: float) -> Matrix:
    """What the side's dashpots resist, of waves as fast as the first answer sends them.

    Through a bonded layer's side go pressure waves; a sliding one's slowest mode is the plate's, modulus E*, which its
    springs follow at rest. A dashpot in parallel has no wave speed of its own: none.
    """
    material, target = scene.geometry.material, scene.target
    assert isinstance(target, Layer)
    if material.young.viscosity:
        return None
    leaving = material.confined_modulus() if target.base == "bonded" else material.contact_modulus()
    return scale * (
        _impedance(material, leaving.glassy) * unit.leaving + _impedance(material, material.shear.glassy) * unit.sliding
    )


def _impedance(material: Material, modulus: float) -> float:
    """Pa s/m."""
    return math.sqrt(modulus * (material.density or 0.0))
