"""Round bodies struck by their like: both finite, each free or held from its middle plane on."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from types import ModuleType

import numpy as np
import numpy.typing as npt
from skfem import Basis

import meshes
from fe_contact.contact import PressedSurface
from fe_contact.floating import Floating
from fe_contact.forms import Array, isotropic, plane_stiffness, stiffness
from fe_contact.numerics import Numerics
from fe_contact.operators import ELEMENTS, SurfaceOperator, condensed
from fe_contact.pressing import Still
from fe_contact.surface import crown
from fe_contact.targets._body import BodyStill, stacked
from fe_contact.targets._zone import LINE_REFINEMENT, SPHERE_REFINEMENT, Zone
from lumped.indenter import Indenter
from lumped.materials import Material
from lumped.targets._round import Round

SPARE = 1.05  # the larger body's fine mesh over what the contact may reach on the smaller


@dataclass(frozen=True)
class _Body:
    """One of the two: its radius, m, elastic material, and whether it is held from its middle plane on."""

    radius: float
    material: Material
    held: bool

    def operator(self, radii: Array, numerics: Numerics, plane: bool) -> SurfaceOperator:
        """Condensed in units of its radius; ``radii``, m: where the contacts to come may end."""
        zone, refinement = Zone.round(radii, self.radius), LINE_REFINEMENT if plane else SPHERE_REFINEMENT
        elements = refinement * numerics.elements_per_contact
        return _operator(self.material.nu, elements, numerics.order, zone.smallest, zone.reference, self.held, plane)

    @property
    def modulus(self) -> float:
        """E*, Pa."""
        return self.material.contact_modulus().relaxed


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """Both bodies at rest; ``radii``, m: where their undeformed surfaces overlap. A striker with a material is free."""
    first, *others = _bodies(indenter)
    plane = indenter.shape.plane
    own = first.operator(radii, numerics, plane)
    surface, unknowns = PressedSurface(own.stiffness, own.trace, own.weights, recurring=False), own.degrees_of_freedom
    for other in others:
        larger = other.operator(SPARE * radii, numerics, plane)
        surface = stacked(own, larger, first.radius / other.radius, _shares(first, other, own.dimension))
        unknowns += larger.degrees_of_freedom
    return BodyStill(
        surface=surface,
        operator=own,
        places=first.radius * np.sin(own.points),
        scale=first.radius,
        indenter=indenter,
        numerics=numerics,
        degrees_of_freedom=unknowns,
    )


def _bodies(indenter: Indenter) -> list[_Body]:
    """The bodies that yield, the smaller one first: its surface ends first."""
    target = indenter.target
    assert isinstance(target, Round)
    bodies = [_Body(target.radius, indenter.material, target.support == "held")]
    if indenter.striker_material is not None:
        bodies.append(_Body(indenter.shape.tip_radius or target.radius, indenter.striker_material, False))
    return sorted(bodies, key=lambda body: body.radius)


def _shares(first: _Body, second: _Body, dimension: int) -> tuple[float, float]:
    """Stiffness of each over that of the common modulus, in units of the first one's radius.

    A body's stiffness grows with its radius; per unit length in plane strain it does not.
    """
    common = 1.0 / (1.0 / first.modulus + 1.0 / second.modulus)
    return first.modulus / common, second.modulus / common * (second.radius / first.radius) ** (dimension - 2)


@lru_cache(maxsize=32)
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
