"""A scene as a body that moves: what a target with inertia hands to the march.

A body is meshed once, in units of its mesh (:class:`UnitBody`). In SI units it is one side of a contact
(:class:`WaveSide`), under a rigid striker or under one pressure with other sides at common points.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sparse

from fe_contact.assembly.forms import Array, Basis, Indices, Matrix, vector_dofs
from fe_contact.assembly.surface import Surface
from fe_contact.dynamics.body import BodyState, BodyWithMass, Part, Pressing
from fe_contact.dynamics.flow import Yields
from fe_contact.dynamics.mass.base import MASSES
from lumped.scene.scene import Scene

SMALLEST = 0.1  # contact radius over the largest one down to which every contact is resolved alike
BEYOND = 1e3  # height, in contact radii, given to radii past the striker's rim


@dataclass(frozen=True, eq=False)
class UnitBody:
    """Matrices for moduli, impedances and density one, in units of the mesh, sparse (n, n), without what is held.

    The scalar scikit-fem ``basis``, of whose degrees of freedom, two a node, some are ``held``; ``surface`` where it
    may be touched. ``local`` makes the consistent mass of every element, (e, k, k), put on the nodes as ``masses``
    says; ``springs`` the stiffness of each of its moduli and ``absorbing`` the dashpots of each of its impedances, of
    all degrees of freedom, (2 N, 2 N): assembled when a march asks for them, not where the work is only counted.
    """

    basis: Basis
    surface: Surface
    held: Indices
    masses: str
    local: Callable[[], Array]
    springs: Callable[[], Sequence[Matrix]]
    absorbing: Callable[[], Sequence[Matrix]] = tuple

    @cached_property
    def free(self) -> Indices:
        """Which degrees of freedom the matrices have, (n,)."""
        return np.setdiff1d(np.arange(2 * self.basis.N), self.held)

    @property
    def unknowns(self) -> int:
        """n."""
        return int(self.free.size)

    @cached_property
    def mass(self) -> Matrix:
        """For density one."""
        dofs, pressed = vector_dofs(self.basis.element_dofs), 2 * self.surface.dofs + 1
        return self._inside(MASSES.get(self.masses).of(self.local(), dofs, 2 * self.basis.N, pressed))

    @cached_property
    def stiffness(self) -> tuple[Matrix, ...]:
        """For each of its moduli."""
        return tuple(self._inside(matrix) for matrix in self.springs())

    @cached_property
    def dashpots(self) -> tuple[Matrix, ...]:
        """For each of its impedances."""
        return tuple(self._inside(matrix) for matrix in self.absorbing())

    def _inside(self, matrix: Matrix) -> Matrix:
        return matrix.tocsc()[self.free][:, self.free]

    @cached_property
    def zone(self) -> tuple[Array, Array, Array]:
        """Points where it may be touched and their areas, each (q,), and the trace there of its nodes, (q, m)."""
        return self.surface.quadrature(self.basis.elem.maxdeg)

    @property
    def axial(self) -> Array:
        """(n,): one for displacements along the axis, zero across."""
        return np.asarray(self.free % 2, dtype=np.float64)

    def pushed(self, count: int) -> Matrix:
        """Nodal forces of unit forces into the body, z < 0, on the first so many surface nodes, sparse (n, count)."""
        rows = np.searchsorted(self.free, 2 * self.surface.dofs[:count] + 1)
        return sparse.csc_matrix((-np.ones(count), (rows, np.arange(count))), shape=(self.free.size, count))

    def everywhere(self, values: Array) -> Array:
        """Values of the matrices' degrees of freedom, the first n, on all nodes, (2 N,)."""
        full = np.zeros(2 * self.basis.N)
        full[self.free] = values[: self.free.size]
        return full


@dataclass(frozen=True, eq=False)
class WaveSide:
    """One of the bodies, n degrees of freedom of its own, SI units; its axis points out of it at the first touch.

    ``mass``, ``dashpots`` (or None) and the stiffness of its ``parts`` sparse (n, n); ``push`` (n, m) nodal forces of
    unit surface forces, ``trace`` (q, m) from its surface nodes to the points; ``axial`` (n,) one along its axis, zero
    throughout for a body that does not fly.
    """

    mass: Matrix
    parts: tuple[Part, ...]
    dashpots: Matrix
    push: Matrix
    trace: Array
    axial: Array

    @property
    def size(self) -> int:
        """Degrees of freedom."""
        return int(self.axial.size)

    @cached_property
    def mean(self) -> Array:
        """(n,): weights of all displacements in that of its centre of mass along the axis; none where it rests."""
        carried = (self.mass @ self.axial) * self.axial
        return np.asarray(carried / (carried.sum() or 1.0))

    def among(self, before: int, after: int) -> WaveSide:
        """The same among so many degrees of freedom of others, which it does not feel."""
        return replace(
            self,
            mass=_among(self.mass, before, after),
            parts=tuple(Part(_among(part.stiffness, before, after), part.relaxation) for part in self.parts),
            dashpots=None if self.dashpots is None else _among(self.dashpots, before, after),
            push=sparse.vstack([_none(before, self.push.shape[1]), self.push, _none(after, self.push.shape[1])]),
            axial=np.concatenate([np.zeros(before), self.axial, np.zeros(after)]),
        )


def together(
    sides: Sequence[WaveSide], gravity: float, weights: Array, clearance: Array, carriers: Array | None
) -> BodyWithMass:
    """One body of all sides, one after the other; ``gravity``, m/s2, pulls the first; areas and overlaps (q,).

    ``carriers``: what the pressure between two of them is made of, as in Pressing.
    """
    ends = np.cumsum([side.size for side in sides])
    placed = [side.among(end - side.size, ends[-1] - end) for side, end in zip(sides, ends, strict=True)]
    dashpots = [side.dashpots for side in placed if side.dashpots is not None]
    return BodyWithMass(
        mass=sum(side.mass for side in placed).tocsc(),
        rigid=np.zeros(ends[-1]),
        parts=tuple(part for side in placed for part in side.parts),
        dashpots=sum(dashpots[1:], dashpots[0]).tocsc() if dashpots else None,
        gravity=gravity * placed[0].axial,
        pressing=Pressing(
            push=sparse.hstack([side.push for side in placed]).tocsc(),
            trace=np.hstack([side.trace for side in sides]),
            weights=weights,
            clearance=clearance,
            carriers=carriers,
        ),
    )


def with_rigid(scene: Scene, side: WaveSide, pressing: Pressing, yields: Yields | None = None) -> BodyWithMass:
    """A body and the rigid striker of a scene, the last degree of freedom; ``pressing`` and ``yields`` of both."""
    rigid, gravity = np.zeros(side.size + 1), np.zeros(side.size + 1)
    rigid[-1], gravity[-1] = scene.reduced_mass, scene.gravity
    both = side.among(0, 1)
    return BodyWithMass(both.mass, rigid, both.parts, both.dashpots, gravity, pressing, yields)


def _among(matrix: Matrix, before: int, after: int) -> Matrix:
    return sparse.block_diag([_none(before, before), matrix, _none(after, after)]).tocsc()


def _none(rows: int, columns: int) -> sparse.csc_matrix:
    return sparse.csc_matrix((rows, columns))


@dataclass(frozen=True, eq=False)
class Moving:
    """A body at first touch and the striker that is its last degree of freedom, its depth.

    ``places`` (q,) of the points that may touch, m from the axis; ``endless``: nothing comes back of its waves.
    """

    body: BodyWithMass
    speed: float
    places: Array
    endless: bool

    @classmethod
    def under(
        cls,
        scene: Scene,
        side: WaveSide,
        places: Array,
        areas: Array,
        highest: float,
        yields: Yields | None = None,
    ) -> Moving:
        """An endless body at rest, points where it may be touched and their areas, under the rigid striker of a scene,
        of which no place counts as higher than the ``highest``, m; what of both ``yields``.
        """
        pressing = Pressing(
            push=sparse.block_diag([side.push, [[-1.0]]]).tocsc(),  # into the body, and the striker out of it
            trace=np.hstack([side.trace, np.ones((places.size, 1))]),
            weights=areas,
            clearance=-np.minimum(scene.profile.height(places), highest),
        )
        return cls(with_rigid(scene, side, pressing, yields), scene.velocity, places, endless=True)

    @property
    def velocity(self) -> Array:
        """At first touch, (N,): the striker moves, the target does not."""
        velocity = np.zeros(self.body.size)
        velocity[-1] = self.speed
        return velocity

    @property
    def watch(self) -> Matrix:
        """Picks the depth, sparse (1, N)."""
        return sparse.csr_matrix(([1.0], ([0], [self.body.size - 1])), shape=(1, self.body.size))

    def in_striker(self, state: BodyState) -> tuple[float, float]:
        """Energy in the motion and in the strain of the striker, J."""
        return 0.5 * float(self.body.rigid @ state.velocity**2), 0.0


@dataclass(frozen=True, eq=False)
class Flying(Moving):
    """The same with a striker that yields: the first ``yielding`` degrees of freedom, the body's first part.

    ``start`` (N,): every whole body's share of the speed; ``approach`` (N,): weights of all displacements in the depth.
    """

    yielding: int
    start: Array
    approach: Array

    @property
    def velocity(self) -> Array:
        """A whole body moves alike everywhere."""
        return self.speed * self.start

    @property
    def watch(self) -> Matrix:
        """The approach of the centres of mass, sparse (1, N)."""
        return sparse.csr_matrix(self.approach[None])

    def in_striker(self, state: BodyState) -> tuple[float, float]:
        """All its motion, and its springs."""
        own = np.where(np.arange(self.body.size) < self.yielding, state.velocity, 0.0)
        strain = self.body.parts[0].stored(state.displacement, state.branches[0], state.pulls[0])
        return 0.5 * float(own @ (self.body.mass @ own)), strain
