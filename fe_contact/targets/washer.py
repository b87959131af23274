"""The washer under a flat end: its section, graded to the rim of the punch and to the corners of a bonded base."""

from __future__ import annotations

import meshes
from fe_contact.assembly.cache import Recipe, cached
from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import ElasticBody, SolidMesh, basis_on, made
from fe_contact.assembly.surface import face
from fe_contact.bodies.bulk_memory import Moduli
from fe_contact.bodies.pressing import FINITE_REFINEMENT, SHARP_REFINEMENT, BodyStill, Still, held, thickness_over
from fe_contact.settings import Numerics
from fe_contact.steppers import bulk_surface
from fe_contact.steppers.bulk_surface import BulkSurface, Pace
from fe_contact.steppers.scaled_surface import on_mesh
from fe_contact.targets.base import MeshedTarget
from lumped.scene.geometry import Geometry
from lumped.scene.indenter import Indenter
from lumped.targets import Target
from lumped.targets.washer import Washer

Sizes = tuple[float, int, float, float, float, bool]  # elements, order, radii of hole, edge and rim, bonded: see _body
COARSER = 0.75  # elements along the shortest length over those along a contact that may end anywhere


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """The washer at rest; ``radii``, m: where the contact ends, alike at every depth."""
    target = indenter.target
    assert isinstance(target, Washer)
    surface = on_mesh(_body.recipe(*_sizes(target, float(radii.max()), numerics)), indenter.material.nu)
    return BodyStill.alone(surface, target.height * surface.operator.points, target.height, indenter, numerics)


def solid(indenter: Indenter, radii: Array, numerics: Numerics) -> SolidMesh:
    """The washer for large strains, covered by a punch; no finer at its corners, where stresses are infinite."""
    target = indenter.target
    assert isinstance(target, Washer)
    elements, order, inner, outer, rim, bonded = _sizes(target, target.outer_radius, numerics)
    refinement = SHARP_REFINEMENT if bonded else FINITE_REFINEMENT
    body = _body(refinement * elements, order, inner, outer, rim, bonded, False)
    return SolidMesh(body, target.height, covered=True, ends=True, sharp=bonded)


def relaxing(geometry: Geometry, numerics: Numerics) -> BulkSurface:
    """The washer of constant bulk modulus in an impact."""
    target, rim = geometry.target, geometry.target.fixed_radius(geometry.shape)
    assert isinstance(target, Washer)
    moduli = Moduli.of(geometry.material, geometry.shape.total)
    return bulk_surface.relaxing(meshed(geometry, numerics), moduli, Pace.of(numerics), target.height, rim)


def meshed(geometry: Geometry, numerics: Numerics) -> Recipe[ElasticBody]:
    """The same for every Poisson's ratio."""
    return _body.recipe(*_sizes(geometry.target, geometry.target.fixed_radius(geometry.shape) or 0.0, numerics))


def _sizes(target: Target, rim: float, numerics: Numerics) -> Sizes:
    """In units of the height; contact ends at ``rim``, m."""
    assert isinstance(target, Washer)
    thickness_over(target.outer_radius - target.inner_radius, target.height)
    inner, outer, end = (length / target.height for length in (target.inner_radius, target.outer_radius, rim))
    return COARSER * numerics.elements_per_contact, numerics.order, inner, outer, end, target.base == "bonded"


@cached
def _body(
    elements: float, order: int, inner: float, outer: float, rim: float, bonded: bool, graded: bool = True
) -> ElasticBody:
    """Of unit height, loaded up to the rim alone; ``graded`` to the corners of a bonded base."""
    basis = basis_on(made(meshes.washer, elements, inner, outer, rim, bonded and graded), order)
    fixed = held(basis, along=("base",) if bonded else (), across=("base",))
    return ElasticBody.alone(basis, fixed, face(basis, rim))


MEMBER = MeshedTarget(still, relaxing=relaxing, solid=solid)
