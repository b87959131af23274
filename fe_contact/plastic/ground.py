"""The half-space that yields: one mesh that resolves every contact radius alike, its core plastic, the rest linear.

Lengths are in units of the widest contact, moduli of E*.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

import meshes
from fe_contact.assembly.cache import cached
from fe_contact.assembly.forms import Array, Basis, Indices, Matrix
from fe_contact.assembly.operators import MOST_UNKNOWNS, element, made, moduli, system_matrix
from fe_contact.assembly.surface import flat
from fe_contact.bodies.pressing import held
from fe_contact.errors import BodyTooFine
from fe_contact.solids.base import State
from fe_contact.solids.bulk import Bulk, CoredBody
from fe_contact.solids.contact import OnUndeformed, Skin
from fe_contact.solids.newton import Encounter
from fe_contact.solids.plastic import Plastic
from lumped.materials.plasticity import Yielding
from lumped.shapes import Shape

if TYPE_CHECKING:
    from skfem import MeshTri

CORE = 4.0  # widest contacts: up to there the material may yield
GUARD = 0.8  # of the core: if it yields beyond, the core is too small
NEAR = 0.5  # of the far radius: where the mesh is cut to see what the far field changes


@dataclass(frozen=True)
class Sizes:
    """Of a mesh: elements along every contact radius, their order, the smallest contact over the widest, far radius.

    ``rim``: whether all contacts end at radius 1; ``cut``: the same mesh without its outer half.
    """

    elements: float
    order: int
    smallest: float
    far_radius: float
    rim: bool = False
    cut: bool = False


@dataclass(frozen=True, eq=False)
class Ground:
    """What a rigid ``profile`` is pressed into; ``unit``: the widest contact, m; ``yielding`` in units of E*;
    ``elements`` (e,) of the ``basis``: those that may yield.
    """

    encounter: Encounter
    yielding: Yielding
    outer: npt.NDArray[np.bool_]
    rim: bool
    basis: Basis
    elements: Indices

    @property
    def rest(self) -> State:
        """What the points remember that nothing has pressed."""
        return at_rest(self.encounter.body.core.weight.shape)

    @cached_property
    def points(self) -> Array:
        """Radii of the quadrature points of the surface, ascending (q,)."""
        return np.asarray(self.encounter.skin.place[0].ravel())

    @property
    def unknowns(self) -> int:
        """Of every Newton step."""
        return self.encounter.body.free.size

    def contained(self, state: State) -> bool:
        """Whether nothing has yielded near the end of the core."""
        return not np.any(state[1][self.outer] > 0.0)

    def stored(self, displacement: Array, state: State) -> float:
        """Elastic energy of a displacement (2 N,) in units of E* and length."""
        body = self.encounter.body
        points = self.yielding.stored(body.core.gradient(displacement), state[0])
        rim = displacement[body.rim]
        return float(np.vdot(body.core.weight, points) + 0.5 * rim @ body.rest @ rim)

    def worked(self, state: State) -> float:
        """Plastic work in these units."""
        return float(np.vdot(self.encounter.body.core.weight, self.yielding.worked(state[1])))


@cached
def ground_of(profile: Shape, unit: float, yielding: Yielding, poisson: float, sizes: Sizes) -> Ground:
    """The same for all runs on a mesh. Raises BodyTooFine."""
    meshed = _meshed(sizes, poisson)
    rest = at_rest(meshed.core.weight.shape)
    body = CoredBody.of(meshed.core, Plastic(yielding), meshed.stiffness, meshed.fixed, rest)
    encounter = Encounter.of(body, meshed.skin, OnUndeformed(profile, unit))
    return Ground(encounter, yielding, meshed.outer, sizes.rim, meshed.basis, meshed.elements)


def at_rest(shape: tuple[int, ...]) -> State:
    """No plastic strain at points of this shape."""
    return (np.zeros((4, *shape)), np.zeros(shape))


@dataclass(frozen=True, eq=False)
class MeshedGround:
    """All of a body that is known before its strength: its core, whole stiffness for E* = 1, held degrees of freedom,
    skin; which elements of the core are its outermost, and which of the basis are the core's.
    """

    core: Bulk
    stiffness: Matrix
    fixed: Indices
    skin: Skin
    outer: npt.NDArray[np.bool_]
    basis: Basis
    elements: Indices


@cached
def _meshed(sizes: Sizes, poisson: float) -> MeshedGround:
    basis = _basis(_mesh(sizes), sizes.order)
    middles = basis.mesh.p[:, basis.mesh.t].mean(axis=1)
    distance = np.hypot(middles[0], middles[1])
    elements = np.flatnonzero(distance < CORE)
    return MeshedGround(
        core=Bulk.of(basis, False, elements),
        stiffness=system_matrix(basis, poisson),
        fixed=held(basis, along=("axis",), across=()),
        skin=Skin.of(flat(basis), sizes.order, 2 * basis.N),
        outer=distance[elements] > GUARD * CORE,
        basis=basis,
        elements=elements,
    )


def _mesh(sizes: Sizes) -> MeshTri:
    """Quarter disc, or, under a rim, a box; coordinates (r, z), what lies beyond it the boundary ``far``."""
    far = sizes.far_radius
    if sizes.rim:
        mesh = made(meshes.layer_under_rim, sizes.elements, far, far)
    else:
        mesh = made(meshes.half_space_under_contacts, sizes.elements, sizes.smallest, far)
    if sizes.cut:
        middles = mesh.p[:, mesh.t].mean(axis=1)
        mesh = mesh.restrict(np.flatnonzero(np.hypot(middles[0], middles[1]) < NEAR * far))
    return mesh.with_boundaries(
        {
            "surface": lambda x: x[1] == 0.0,
            "axis": lambda x: x[0] == 0.0,
            "far": lambda x: (x[0] > 0.0) & (x[1] < 0.0),
        }
    )


def _basis(mesh: MeshTri, order: int) -> Basis:
    """Of scalar functions, with points of degree 2 order - 1: more would resist plastic flow. Raises BodyTooFine."""
    from skfem import CellBasis

    unknowns = 2 * order**2 * int(mesh.nvertices)
    if unknowns > MOST_UNKNOWNS:
        raise BodyTooFine(f"a body of {unknowns} unknowns", f"accepted up to {MOST_UNKNOWNS}")
    return CellBasis(mesh, element(order), intorder=2 * order - 1)


def yielding_of(poisson: float, strength: float, hardening: float) -> Yielding:
    """For E* = 1; strength and hardening over E*."""
    return Yielding(*moduli(poisson), strength, hardening)
