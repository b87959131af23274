"""The half-space that yields: one mesh that resolves every contact radius alike, its core plastic, the rest linear.

Lengths are in units of the widest contact, moduli of E*.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

import meshes
from fe_contact.assembly.cache import cached
from fe_contact.assembly.far_field import robin
from fe_contact.assembly.forms import Array, Basis, Indices, Matrix, isotropic, stiffness
from fe_contact.assembly.operators import MOST_UNKNOWNS, element, made, moduli
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
class Nest:
    """The ground under contacts up to a ``reach``: its first elements may yield, ``outer`` of them the outermost."""

    reach: float
    encounter: Encounter
    outer: npt.NDArray[np.bool_]

    def holds(self, state: State) -> bool:
        """Whether nothing has yielded beyond it."""
        return not np.any(state[1][self.outer.size :] > 0.0)

    def contained(self, state: State) -> bool:
        """Whether nothing has yielded near its end, or beyond."""
        return self.holds(state) and not np.any(state[1][: self.outer.size][self.outer] > 0.0)

    def part(self, state: State) -> State:
        """Of what all points remember, what is its own."""
        return tuple(values[..., : self.outer.size, :] for values in state)

    def whole(self, part: State, state: State) -> State:
        """What all points remember, with its own part anew."""
        pairs = zip(part, state, strict=True)
        return tuple(np.concatenate([own, all_[..., self.outer.size :, :]], axis=-2) for own, all_ in pairs)


@dataclass(frozen=True, eq=False)
class Ground:
    """What a rigid ``profile`` is pressed into; ``unit``: the widest contact, m; ``yielding`` in units of E*.

    ``nests``: those of its parts that were asked for, by their reach.
    """

    meshed: MeshedGround
    obstacle: OnUndeformed
    yielding: Yielding
    nests: dict[float, Nest] = field(default_factory=dict)

    @property
    def rim(self) -> bool:
        """Whether all contacts end at radius 1."""
        return self.meshed.sizes.rim

    @property
    def rest(self) -> State:
        """What the points remember that nothing has pressed."""
        return at_rest(self.core.weight.shape)

    def nest(self, radius: float, state: State) -> Nest:
        """The smallest that holds a contact of this radius and all that has yielded."""
        least = 1.0 if self.rim else max(radius, self.meshed.sizes.smallest)
        reach = min(2.0 ** math.ceil(math.log2(least)), 1.0)
        while reach < 1.0 and not self._nest(reach).holds(state):
            reach *= 2.0
        return self._nest(reach)

    def _nest(self, reach: float) -> Nest:
        """Made once; what it leaves out is condensed."""
        if reach not in self.nests:
            known = self.meshed
            near = known.distance[known.distance < CORE * reach]
            core = known.core.first(near.size)
            rest = at_rest(core.weight.shape)
            body = CoredBody.of(core, Plastic(self.yielding), known.stiffness, known.fixed, rest)
            encounter = Encounter.of(body, known.skin, self.obstacle)
            self.nests[reach] = Nest(reach, encounter, near > GUARD * CORE * reach)
        return self.nests[reach]

    @property
    def core(self) -> Bulk:
        """All that may yield."""
        return self.meshed.core

    @property
    def basis(self) -> Basis:
        """Of the whole mesh."""
        return self.meshed.basis

    @property
    def elements(self) -> Indices:
        """Those of the basis that may yield, the core's, (e,)."""
        return self.meshed.elements

    @cached_property
    def points(self) -> Array:
        """Radii of the quadrature points of the surface, ascending (q,)."""
        return np.asarray(self.meshed.skin.place[0].ravel())

    @property
    def unknowns(self) -> int:
        """Of a Newton step under the widest contacts."""
        return self._nest(1.0).encounter.body.free.size

    def stored(self, displacement: Array, state: State) -> float:
        """Elastic energy of a displacement (2 N,) in units of E* and length."""
        body = self._nest(1.0).encounter.body
        points = self.yielding.stored(body.core.gradient(displacement), state[0])
        rim = displacement[body.rim]
        return float(np.vdot(body.core.weight, points) + 0.5 * rim @ body.rest @ rim)

    def worked(self, state: State) -> float:
        """Plastic work in these units."""
        return float(np.vdot(self.core.weight, self.yielding.worked(state[1])))


def at_rest(shape: tuple[int, ...]) -> State:
    """No plastic strain at points of this shape."""
    return (np.zeros((4, *shape)), np.zeros(shape))


@dataclass(frozen=True, eq=False)
class MeshedGround:
    """All of a body that is known before its strength: whole stiffness for E* = 1, held degrees of freedom, skin;
    which ``elements`` (e,) of the ``basis`` are its core's, by ``distance`` (e,) from the first touch.
    """

    sizes: Sizes
    basis: Basis
    elements: Indices
    distance: Array
    core: Bulk
    stiffness: Matrix
    fixed: Indices
    skin: Skin


@cached
def ground_of(profile: Shape, unit: float, yielding: Yielding, poisson: float, sizes: Sizes) -> Ground:
    """Raises BodyTooFine."""
    return Ground(_meshed(sizes, poisson), OnUndeformed(profile, unit), yielding)


@cached
def _meshed(sizes: Sizes, poisson: float) -> MeshedGround:
    basis = _basis(_mesh(sizes), sizes.order)
    middles = basis.mesh.p[:, basis.mesh.t].mean(axis=1)
    distance = np.hypot(middles[0], middles[1])
    elements = np.argsort(distance, kind="stable")[: np.count_nonzero(distance < CORE)]
    return MeshedGround(
        sizes=sizes,
        basis=basis,
        elements=elements,
        distance=distance[elements],
        core=Bulk.of(basis, False, elements),
        stiffness=_stiffness(basis, poisson),
        fixed=held(basis, along=("axis",), across=()),
        skin=Skin.of(flat(basis), sizes.order, 2 * basis.N),
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


def _stiffness(basis: Basis, poisson: float) -> Matrix:
    """With the far field, for E* = 1, sparse (2 N, 2 N)."""
    from skfem import FacetBasis

    order = basis.elem.maxdeg
    outside = FacetBasis(basis.mesh, basis.elem, facets=basis.mesh.boundaries["far"], intorder=2 * order + 4)
    return (stiffness(basis, isotropic(1.0 - poisson**2, poisson)) + robin(outside, poisson)).tocsc()


def yielding_of(poisson: float, strength: float, hardening: float) -> Yielding:
    """For E* = 1; strength and hardening over E*."""
    return Yielding(*moduli(poisson), strength, hardening)
