"""Round bodies struck by their like: both finite, each free or held from its middle plane on."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType

import numpy as np
import numpy.typing as npt
from skfem import Basis

import meshes
from fe_contact.bodies.stacked import Side, Stacked, stacked
from fe_contact.floating import Floating
from fe_contact.forms import Array, isotropic, plane_stiffness, stiffness
from fe_contact.kept import kept
from fe_contact.numerics import Numerics
from fe_contact.operators import ELEMENTS, SurfaceOperator, condensed
from fe_contact.pressing import Still
from fe_contact.surface import crown
from fe_contact.targets._body import BodyStill, trace_at
from fe_contact.targets._zone import (
    LINE_REFINEMENT,
    MARGIN,
    SPHERE_REFINEMENT,
    STRUCK_REFINEMENT,
    Zone,
    smallest_struck,
)
from lumped.geometry import Geometry
from lumped.indenter import Indenter
from lumped.materials import Material
from lumped.targets._round import Round

SPARE = 1.05  # the larger body's fine mesh over what the contact may reach on the smaller


@dataclass(frozen=True)
class _Body:
    """One of the two: its radius, m, material, and whether it is held from its middle plane on."""

    radius: float
    material: Material
    held: bool

    def operator(self, zone: Zone, elements: float, order: int, plane: bool) -> SurfaceOperator:
        """Condensed in units of its radius; ``elements`` along a contact's half-width."""
        return _operator(self.material.nu, elements, order, zone.smallest, zone.reference, self.held, plane)


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """Both bodies at rest; ``radii``, m: where their undeformed surfaces overlap. A striker with a material is free."""
    shape = indenter.shape
    geometry = Geometry(shape, indenter.target, indenter.material, indenter.striker_material)
    refinement = LINE_REFINEMENT if shape.plane else SPHERE_REFINEMENT
    ends = (float(radii.min()), float(radii.max()))
    bodies = _together(geometry, ends, refinement * numerics.elements_per_contact, numerics.order)
    moduli = [side.relaxation.relaxed for side in bodies.sides]
    common = 1.0 / sum(1.0 / modulus for modulus in moduli)
    return BodyStill(
        surface=stacked(bodies.operator, bodies.sides, tuple(modulus / common for modulus in moduli)),
        operator=bodies.operator,
        places=bodies.places(bodies.radius),
        scale=bodies.radius,
        indenter=indenter,
        numerics=numerics,
        degrees_of_freedom=bodies.degrees_of_freedom,
    )


def struck(geometry: Geometry, numerics: Numerics) -> Stacked:
    """Both bodies in an impact whose contact grows from nothing to the radius that the settings expect."""
    largest = numerics.contact_radius / MARGIN
    ends = (smallest_struck(geometry.shape) * largest, largest)
    return _together(geometry, ends, STRUCK_REFINEMENT * numerics.elements_per_contact, numerics.order)


@kept
def _together(geometry: Geometry, ends: tuple[float, float], elements: float, order: int) -> Stacked:
    """All bodies that yield, on meshes fine for contacts that end between these radii, m."""
    radii = np.array(ends)
    first, *others = _bodies(geometry)
    shape = geometry.shape
    own = first.operator(Zone.round(radii, first.radius), elements, order, shape.plane)
    sides = [Side(own, shape.modulus(first.material).scaled(shape.total), own.trace)]
    for other in others:
        larger = other.operator(Zone.round(SPARE * radii, other.radius), elements, order, shape.plane)
        ratio = first.radius / other.radius
        trace = trace_at(larger, np.arcsin(np.minimum(ratio * np.sin(own.points), 1.0)))
        relaxation = shape.modulus(other.material).scaled(shape.total)
        sides.append(Side(larger, relaxation, trace, ratio ** (2 - own.dimension)))
    return Stacked(own, tuple(sides), first.radius)


def _bodies(geometry: Geometry) -> list[_Body]:
    """The bodies that yield, the smaller one first: its surface ends first."""
    target = geometry.target
    assert isinstance(target, Round)
    bodies = [_Body(target.radius, geometry.material, target.support == "held")]
    if geometry.striker_material is not None:
        bodies.append(_Body(geometry.shape.tip_radius or target.radius, geometry.striker_material, False))
    return sorted(bodies, key=lambda body: body.radius)


@kept
def _operator(
    poisson: float, elements: float, order: int, smallest: float, contact: float, support: bool, plane: bool
) -> SurfaceOperator:
    """Condensed for unit radius, points and ``contact`` in rad from the pole; ``support``: whether it is held."""
    module: ModuleType = meshes
    mesh = (module.cylinder if plane else module.sphere)(elements, smallest, contact)
    basis = Basis(mesh, ELEMENTS[order](), intorder=2 * order)
    law = isotropic(1.0 - poisson**2, poisson)
    matrix = (plane_stiffness(basis, law) if plane else stiffness(basis, law)).tocsc()
    around = 1.0 if plane else 2.0 * np.pi * np.asarray(basis.global_coordinates())[0]
    floating = None if support else Floating.of(basis, around * np.asarray(basis.dx))
    fixed = _fixed(basis, support)
    surface = crown(basis, contact, None if plane else 0.0)
    return condensed(basis, matrix, fixed, poisson, surface, floating=floating)


def _fixed(basis: Basis, support: bool) -> npt.NDArray[np.int64]:
    """The axis sideways; along it everything from the middle plane on, or the foot of a free body alone."""
    axis = 2 * basis.get_dofs("axis").flatten()
    depth = -basis.doflocs[1]
    if support:
        deep = np.flatnonzero(depth >= 1.0 - 1e-12)
        return np.unique(np.concatenate([axis, 2 * deep, 2 * deep + 1]))
    return np.unique(np.append(axis, 2 * int(np.argmax(depth)) + 1))
