"""Round bodies struck by their like, or striking a plane: finite, each free or held from its middle plane on."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

import meshes
from fe_contact.assembly.cache import Recipe, cached
from fe_contact.assembly.forms import Array, Basis, volumes
from fe_contact.assembly.interior import Floating
from fe_contact.assembly.operators import ElasticBody, basis_on, made
from fe_contact.assembly.surface import crown, trace_between
from fe_contact.bodies.pressing import (
    LINE_REFINEMENT,
    SPHERE_REFINEMENT,
    STRUCK_REFINEMENT,
    BodyStill,
    Still,
    Zone,
    struck_ends,
)
from fe_contact.settings import Numerics
from fe_contact.steppers.bulk_surface import Pace
from fe_contact.steppers.stacked import Stacked, side_of, stacked
from lumped.materials import Material
from lumped.scene.geometry import Geometry
from lumped.scene.indenter import Indenter
from lumped.targets._round import RoundTarget

SPARE = 1.05  # the larger body's fine mesh over what the contact may reach on the smaller


@dataclass(frozen=True)
class _Body:
    """One of the two: its radius, m, material, and whether it is held from its middle plane on."""

    radius: float
    material: Material
    held: bool

    def meshed(self, zone: Zone, elements: float, order: int, plane: bool) -> Recipe[ElasticBody]:
        """In units of its radius; ``elements`` along a contact's half-width."""
        return _meshed.recipe(elements, order, zone.smallest, zone.reference, self.held, plane)


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """Both bodies at rest; ``radii``, m: where their undeformed surfaces overlap. A striker with a material is free."""
    refinement = LINE_REFINEMENT if indenter.shape.plane else SPHERE_REFINEMENT
    ends = (float(radii.min()), float(radii.max()))
    bodies = _together(indenter.geometry, ends, refinement * numerics.elements_per_contact, numerics.order)
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
    elements = STRUCK_REFINEMENT * numerics.elements_per_contact
    return _together(geometry, struck_ends(geometry.shape, numerics), elements, numerics.order)


def relaxing(geometry: Geometry, numerics: Numerics) -> Stacked:
    """The same where at least one is of constant bulk modulus and relaxes."""
    elements = STRUCK_REFINEMENT * numerics.elements_per_contact
    return _together(geometry, struck_ends(geometry.shape, numerics), elements, numerics.order, Pace.of(numerics))


@cached
def _together(
    geometry: Geometry, ends: tuple[float, float], elements: float, order: int, pace: Pace | None = None
) -> Stacked:
    """All bodies that yield, on meshes fine for contacts that end between these radii, m.

    ``pace`` of the impact, where bodies of constant bulk modulus relax.
    """
    radii = np.array(ends)
    first, *others = _bodies(geometry)
    shape = geometry.shape
    finest = first.meshed(Zone.round(radii, first.radius), elements, order, shape.plane)
    own = side_of(finest, first.material, shape, pace)
    sides = [own]
    for other in others:
        larger = other.meshed(Zone.round(SPARE * radii, other.radius), elements, order, shape.plane)
        ratio, power = first.radius / other.radius, 2 - own.operator.dimension
        side = side_of(larger, other.material, shape, pace)
        points = np.arcsin(np.minimum(ratio * np.sin(own.operator.points), 1.0))
        trace = trace_between(side.operator.corners, points, side.operator.order)
        sides.append(replace(side, trace=trace, share=ratio**power))
    return Stacked(own.operator, tuple(sides), first.radius)


def _bodies(geometry: Geometry) -> list[_Body]:
    """The bodies that yield, the smaller one first: its surface ends first."""
    target, own, bodies = geometry.target, geometry.shape.tip_radius, list[_Body]()
    if isinstance(target, RoundTarget):
        bodies.append(_Body(target.radius, geometry.material, target.support == "held"))
    if geometry.striking is not None and own is not None:
        bodies.append(_Body(own, geometry.striking, False))
    return sorted(bodies, key=lambda body: body.radius)


@cached
def _meshed(elements: float, order: int, smallest: float, contact: float, support: bool, in_plane: bool) -> ElasticBody:
    """Of unit radius, points and ``contact`` in rad from the pole; ``support``: whether it is held."""
    mesh = made(meshes.cylinder if in_plane else meshes.sphere, elements, smallest, contact, order, support)
    basis = basis_on(mesh, order)
    floating = None if support else Floating.of(basis, volumes(basis, in_plane))
    surface = crown(basis, contact, None if in_plane else 0.0)
    return ElasticBody.alone(basis, _fixed(basis, support), surface, in_plane, floating)


def _fixed(basis: Basis, support: bool) -> npt.NDArray[np.int64]:
    """The axis sideways; along it everything from the middle plane on, or the foot of a free body alone."""
    axis = 2 * basis.get_dofs("axis").flatten()
    depth = -basis.doflocs[1]
    if support:
        deep = np.flatnonzero(depth >= 1.0 - 1e-12)
        return np.unique(np.concatenate([axis, 2 * deep, 2 * deep + 1]))
    return np.unique(np.append(axis, 2 * int(np.argmax(depth)) + 1))
