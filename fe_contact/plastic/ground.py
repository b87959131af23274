"""The half-space that yields: one mesh in units of the contact radius, its core plastic, the rest linear.

Moduli are in units of E*. The mesh grows with the contact, so that every contact ends at its finest elements; under a
rim it stays as it is.
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
from fe_contact.plastic.growing import Growing
from fe_contact.plastic.settling import Springs, YieldingBody
from fe_contact.solids.base import State
from fe_contact.solids.bulk import Bulk, CoredBody
from fe_contact.solids.contact import Skin
from fe_contact.solids.plastic import Plastic
from lumped.materials.plasticity import Yielding
from lumped.shapes import Shape

if TYPE_CHECKING:
    from skfem import MeshTri

CORE, WIDEST = 4.0, 16.0  # contact radii: up to there the material may yield, at first and at most
GUARD = 0.8  # of the core: if it yields beyond, the core is too small
NEAR = 0.5  # of the far radius: where the mesh is cut to see what the far field changes
AT_EDGE = 8.0  # times finer elements are at the edge: four times fewer of them err less there than at 4
GROWTH = 2.0  # of the mesh: with 1 per unit of length forces differ by less than 2e-4


@dataclass(frozen=True)
class Sizes:
    """Of a mesh: elements along the contact radius, their order, far radius; the radius of its ``core``.

    ``rim``: whether all contacts end at one rim; ``cut``: the same mesh without its outer half.
    """

    elements: float
    order: int
    far_radius: float
    core: float = CORE
    rim: bool = False
    cut: bool = False


@dataclass(frozen=True, eq=False)
class Ground:
    """What a rigid ``profile`` is pressed into, on a mesh of some scale; ``unit`` of these scales, m; ``yielding`` in
    units of E*; ``elements`` (e,) of the ``basis``: those that may yield, up to the radius ``core``; ``growing``: how
    the mesh grows, None under a rim.
    """

    body: YieldingBody
    profile: Shape
    unit: float
    yielding: Yielding
    outer: npt.NDArray[np.bool_]
    growing: Growing | None
    basis: Basis
    elements: Indices
    core: float

    @property
    def rim(self) -> bool:
        """Whether all contacts end at radius 1."""
        return self.growing is None

    def springs(self, scale: float, depth: float, stiffness: float, given: Array) -> Springs:
        """At a ``depth``, in units of a mesh ``scale`` long; a penalty's ``stiffness`` that only mends the pressure
        ``given`` (q,).
        """
        rise = self.profile.height(scale * self.unit * self.points) / (scale * self.unit)
        return Springs(depth - rise + given / stiffness, stiffness * self.body.skin.weights.ravel())

    def carried(self, state: State, growth: float) -> State:
        """What the points remember of a mesh that has become ``growth`` times as large."""
        return state if self.growing is None else self.growing.carried(state, growth)

    @property
    def rest(self) -> State:
        """What the points remember that nothing has pressed."""
        return at_rest(self.body.cored.core.weight.shape)

    @cached_property
    def points(self) -> Array:
        """Radii of the quadrature points of the surface, ascending (q,)."""
        return np.asarray(self.body.skin.place[0].ravel())

    @property
    def unknowns(self) -> int:
        """Of every Newton step."""
        return self.body.cored.free.size

    def contained(self, state: State) -> bool:
        """Whether nothing has yielded near the end of the core."""
        return not np.any(state[1][self.outer] > 0.0)

    def stored(self, displacement: Array, state: State) -> float:
        """Elastic energy of a displacement (2 N,) in units of E* and length."""
        body = self.body.cored
        points = self.yielding.stored(body.core.gradient(displacement), state[0])
        rim = displacement[body.rim]
        return float(np.vdot(body.core.weight, points) + 0.5 * rim @ body.rest @ rim)

    def worked(self, state: State) -> float:
        """Plastic work in these units."""
        return float(np.vdot(self.body.cored.core.weight, self.yielding.worked(state[1])))


@cached
def ground_of(profile: Shape, unit: float, yielding: Yielding, poisson: float, sizes: Sizes) -> Ground:
    """The same for all runs on a mesh. Raises BodyTooFine."""
    meshed = _meshed(sizes, poisson)
    rest = at_rest(meshed.core.weight.shape)
    body = CoredBody.of(meshed.core, Plastic(yielding), meshed.stiffness, meshed.fixed, rest)
    return Ground(
        body=YieldingBody.of(body, meshed.skin, yielding),
        profile=profile,
        unit=unit,
        yielding=yielding,
        outer=meshed.outer,
        growing=meshed.growing,
        basis=meshed.basis,
        elements=meshed.elements,
        core=sizes.core,
    )


def at_rest(shape: tuple[int, ...]) -> State:
    """No plastic strain at points of this shape."""
    return (np.zeros((4, *shape)), np.zeros(shape))


@dataclass(frozen=True, eq=False)
class MeshedGround:
    """All of a body that is known before its strength: its core, whole stiffness for E* = 1, held degrees of freedom,
    skin; how the core grows; which of its elements are its outermost, and which of the basis are the core's.
    """

    core: Bulk
    stiffness: Matrix
    fixed: Indices
    skin: Skin
    growing: Growing | None
    outer: npt.NDArray[np.bool_]
    basis: Basis
    elements: Indices


@cached
def _meshed(sizes: Sizes, poisson: float) -> MeshedGround:
    basis = yielding_basis(_mesh(sizes), sizes.order)
    middles = basis.mesh.p[:, basis.mesh.t].mean(axis=1)
    distance = np.hypot(middles[0], middles[1])
    elements = np.flatnonzero(distance < sizes.core)
    return MeshedGround(
        core=Bulk.of(basis, False, elements),
        stiffness=system_matrix(basis, poisson),
        fixed=held(basis, along=("axis",), across=()),
        skin=Skin.of(flat(basis), sizes.order, 2 * basis.N),
        growing=None if sizes.rim else Growing.of(basis, elements, sizes.order),
        outer=distance[elements] > GUARD * sizes.core,
        basis=basis,
        elements=elements,
    )


def _mesh(sizes: Sizes) -> MeshTri:
    """Quarter disc, or, under a rim, a box; coordinates (r, z), what lies beyond it the boundary ``far``."""
    far = sizes.far_radius
    if sizes.rim:
        mesh = made(meshes.layer_under_rim, sizes.elements, far, far)
    else:
        mesh = made(meshes.half_space, sizes.elements, far, AT_EDGE, GROWTH)
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


def yielding_basis(mesh: MeshTri, order: int) -> Basis:
    """Of scalar functions, with points of degree 2 order - 1: more would resist plastic flow. Raises BodyTooFine."""
    from skfem import CellBasis

    unknowns = 2 * order**2 * int(mesh.nvertices)
    if unknowns > MOST_UNKNOWNS:
        raise BodyTooFine(f"a body of {unknowns} unknowns", f"accepted up to {MOST_UNKNOWNS}")
    return CellBasis(mesh, element(order), intorder=2 * order - 1)


def yielding_of(poisson: float, strength: float, hardening: float, modulus: float = 1.0) -> Yielding:
    """Of a contact modulus E*, and strength and hardening in its unit."""
    bulk, shear = moduli(poisson)
    return Yielding(modulus * bulk, modulus * shear, strength, hardening)
