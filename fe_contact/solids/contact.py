"""A rigid profile pressed on the surface of a body by a penalty at quadrature points, without friction.

Energy K/2 int <g>^2 dA over the undeformed area, g the overlap along the motion; forces and tangent are its
derivatives, by the same quadrature as the force on the striker.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from fe_contact.assembly.forms import Array, Indices, vector_dofs
from fe_contact.assembly.surface import FACET_POINTS, Surface
from lumped.shapes import Shape

Points = npt.NDArray[np.bool_]  # which of them, (facets, points)
BEND = 1e-5  # rounding: step of the quotient that tells a profile's curvature, over the radius


class Overlap(NamedTuple):
    """``depth`` (...) of points within the striker, m; ``normal`` (2, ...) its derivative by their displacement (r, z);
    ``bend`` (2, 2, ...) its second one, 1/m. A striker that moves by one is a body that moves against it.
    """

    depth: Array
    normal: Array
    bend: Array


class Obstacle(Protocol):
    """A rigid striker above a body z <= 0."""

    def overlap(self, place: Array, displacement: Array, depth: float) -> Overlap:
        """Of points at ``place`` (2, ...), displaced by ``displacement`` (2, ...), with the striker ``depth`` deep."""

    def along(self, place: Array) -> Array:
        """Distance of deformed places (2, ...) from the first touch, as a contact radius counts it, (...)."""


@dataclass(frozen=True)
class OnDeformed:
    """Heights of a ``profile``, lengths in units of ``unit`` m, where the points have come to."""

    profile: Shape
    unit: float

    def overlap(self, place: Array, displacement: Array, depth: float) -> Overlap:
        """See :class:`Obstacle`."""
        radius, height = place + displacement
        side, within = np.sign(radius), self.unit * np.abs(radius)
        rise, slope = self.profile.height(within) / self.unit, side * self.profile.slope(within)
        above, below = within * (1.0 + BEND), within * (1.0 - BEND)
        with np.errstate(invalid="ignore"):
            bend = (self.profile.slope(above) - self.profile.slope(below)) / (2.0 * BEND * np.abs(radius))
            none = np.zeros_like(bend)
            curved = np.array([[-bend, none], [none, none]])
            return Overlap(depth + height - rise, np.stack([-slope, np.ones_like(slope)]), curved)

    def along(self, place: Array) -> Array:
        """From the axis."""
        return np.asarray(place[0])


@dataclass(frozen=True)
class OnRound:
    """Distances from the middle of a circle of this ``radius``, which may fit its bed closely."""

    radius: float

    def overlap(self, place: Array, displacement: Array, depth: float) -> Overlap:
        """See :class:`Obstacle`."""
        away = place + displacement
        away[1] += depth - self.radius
        distance = np.hypot(*away)
        out = away / distance
        square = place[0] + displacement[0], place[1] + displacement[1] + depth
        within = (2.0 * self.radius * square[1] - square[0] ** 2 - square[1] ** 2) / (self.radius + distance)
        turn = (out[:, None] * out[None] - np.eye(2)[:, :, None, None]) / distance
        return Overlap(within, -out, turn)

    def along(self, place: Array) -> Array:
        """Arc of the circle."""
        return np.asarray(self.radius * np.arcsin(np.clip(place[0] / self.radius, -1.0, 1.0)))


@dataclass(frozen=True)
class OnTop:
    """A plane upon a ring of round section, of radius 1 about this ``mean_radius``, or, at 0, upon what is flat."""

    mean_radius: float

    def overlap(self, place: Array, displacement: Array, depth: float) -> Overlap:
        """See :class:`Obstacle`."""
        within = depth + place[1] + displacement[1]
        none = np.zeros_like(within)
        return Overlap(within, np.stack([none, np.ones_like(within)]), np.zeros((2, 2, *within.shape)))

    def along(self, place: Array) -> Array:
        """From the ring's top, left or right."""
        return np.asarray(place[0] - self.mean_radius)

    def place(self, angle: Array) -> Array:
        """Of points of the section at angles from its top, (2, ...)."""
        return np.stack([self.mean_radius + np.sin(angle), np.cos(angle) - 1.0])


def flat_places(coordinate: Array) -> Array:
    """Of a boundary z = 0, (2, ...)."""
    return np.stack([coordinate, np.zeros_like(coordinate)])


@dataclass(frozen=True, eq=False)
class Skin:
    """The facets where contact may happen: ``place`` (2, facets, points) of their quadrature points.

    ``weights`` (facets, points) undeformed area; ``trace`` (points, k) shape functions of a facet; ``dofs`` (facets,
    2 k) of ``size`` of the whole mesh.
    """

    place: Array
    weights: Array
    trace: Array
    dofs: Indices
    size: int

    @classmethod
    def of(cls, surface: Surface, order: int, size: int, placed: Callable[[Array], Array] = flat_places) -> Skin:
        """Of a boundary of elements of an ``order``; ``placed``: where points of its coordinates are, (2, ...)."""
        each = order + FACET_POINTS
        coordinate, weights, trace = surface.quadrature(order)
        nodes = order * np.arange(coordinate.size // each)[:, None] + np.arange(order + 1)
        places, dofs = placed(coordinate.reshape(-1, each)), vector_dofs(surface.dofs[nodes].T)
        return cls(places, weights.reshape(-1, each), trace[:each, : order + 1], dofs, size)

    @cached_property
    def products(self) -> Array:
        """Of every two shape functions of a facet, (points, k k)."""
        return np.asarray((self.trace[:, :, None] * self.trace[:, None]).reshape(len(self.trace), -1))

    def displacement(self, whole: Array) -> Array:
        """At the points, (2, facets, points), from that of the mesh (2 N,)."""
        local = whole[self.dofs]
        return np.stack([local[:, c::2] @ self.trace.T for c in (0, 1)])

    def pressed(
        self, whole: Array, obstacle: Obstacle, depth: float, stiffness: float, touching: Points | None = None
    ) -> Touch:
        """What a striker does to the body displaced by ``whole`` (2 N,); ``stiffness`` of the penalty, Pa/m.

        ``touching``: points (facets, points) that stick to it, pulled or pushed; None: those within it.
        """
        displacement = self.displacement(whole)
        overlap = obstacle.overlap(self.place, displacement, depth)
        return Touch(self, displacement, overlap, stiffness, overlap.depth > 0.0 if touching is None else touching)


@dataclass(frozen=True, eq=False)
class Touch:
    """A skin under a striker."""

    skin: Skin
    displacement: Array
    overlap: Overlap
    stiffness: float
    touching: Points

    @cached_property
    def pressure(self) -> Array:
        """At every point, (facets, points), Pa."""
        return np.where(self.touching, self.stiffness * self.overlap.depth, 0.0)

    @cached_property
    def _pushed(self) -> Array:
        """Force at every point, N."""
        return self.skin.weights * self.pressure

    @cached_property
    def energy(self) -> float:
        """Of the penalty, J."""
        return float(0.5 * np.vdot(self._pushed, self.pressure) / self.stiffness)

    @property
    def force(self) -> float:
        """On the striker, along its motion, N: derivative of the energy by the depth."""
        return float(np.vdot(self._pushed, self.normal[1]))

    @property
    def normal(self) -> Array:
        """Derivative of the overlap, zero where nothing touches."""
        return np.where(self.touching, self.overlap.normal, 0.0)

    @cached_property
    def forces(self) -> Array:
        """Derivative of the energy by the mesh's displacement, (2 N,)."""
        return self._nodal(self._pushed * self.normal)

    @property
    def stiffening(self) -> Array:
        """Derivative of these forces by the depth, (2 N,)."""
        springs = self.stiffness * self.skin.weights * self.normal[1]
        return self._nodal(springs * self.normal + self._pushed * self._bend[:, 1])

    @cached_property
    def _bend(self) -> Array:
        """Second derivative of the overlap, (2, 2, facets, points), zero where nothing touches."""
        return np.where(self.touching, self.overlap.bend, 0.0)

    def _nodal(self, force: Array) -> Array:
        """Nodal forces (2 N,) of forces (2, facets, points) at the points."""
        local = np.empty(self.skin.dofs.shape)
        for c in (0, 1):
            local[:, c::2] = force[c] @ self.skin.trace
        return np.asarray(np.bincount(self.skin.dofs.ravel(), local.ravel(), self.skin.size), dtype=float)

    def matrices(self, convex: bool = False) -> Array:
        """Tangent of every facet, (facets, 2 k, 2 k); ``convex``: without what the striker's bend takes from it."""
        springs, functions = self.stiffness * self.skin.weights * self.touching, self.skin.trace.shape[1]
        local = np.empty((*self.skin.dofs.shape, self.skin.dofs.shape[1]))
        for i in (0, 1):
            for j in (0, 1):
                value = springs * self.normal[i] * self.normal[j]
                if not convex:
                    value = value + self._pushed * self._bend[i, j]
                local[:, i::2, j::2] = (value @ self.skin.products).reshape(-1, functions, functions)
        return local
